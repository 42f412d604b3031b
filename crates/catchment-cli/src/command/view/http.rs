//! The subset of HTTP/1.1 that a local page needs: one request per connection, every size bounded. It works
//! on bytes alone and reads and writes no socket.
//!
//! ```text
//!   bytes ──parse──▶ Request ──admit──▶ path below the token     or an error response:
//!                                                                400 malformed · 403 foreign Host or Origin · 404 no token
//!                                                                408 too slow · 413 too large
//! ```
//!
//! A foreign page cannot send requests: they carry its own Origin, and a host name redirected here (DNS
//! rebinding) carries its own Host.

use super::live_page::ServedPage;
use std::sync::Arc;

/// Largest head of a request, in bytes.
const HEAD_BYTES: usize = 16 << 10;
/// Largest body of a request, in bytes: it holds a resolution.
const BODY_BYTES: usize = 256;

/// A parsed request.
#[derive(Debug, Default, PartialEq, Eq)]
pub(super) struct Request {
    pub(super) method: String,
    /// The path below the token, after admission.
    pub(super) path: String,
    host: Vec<String>,
    origin: Vec<String>,
    pub(super) body: String,
}

/// A response.
#[derive(Debug)]
pub(super) struct Response {
    status: u16,
    kind: &'static str,
    policy: Arc<str>,
    body: Arc<str>,
}

/// The admission rules: Host, Origin and token.
pub(super) struct Gate {
    pub(super) port: u16,
    pub(super) token: String,
}

impl Gate {
    /// Admits a request and reduces its path to the part below the token.
    pub(super) fn admit(&self, request: Request) -> Result<Request, Response> {
        let own =
            |name: &str| ["127.0.0.1", "localhost"].iter().any(|own| name == format!("{own}:{}", self.port));
        if request.host.len() != 1 || !own(&request.host[0]) {
            return Err(Response::text(403, "this page is for this machine alone"));
        }
        let foreign = |origin: &String| !origin.strip_prefix("http://").is_some_and(own);
        if request.origin.iter().any(foreign) {
            return Err(Response::text(403, "no other page may ask here"));
        }
        let mut parts = request.path.splitn(3, '/');
        let (before, token, rest) = (parts.next(), parts.next().unwrap_or_default(), parts.next());
        match (before, rest) {
            (Some(""), Some(rest)) if same(token, &self.token) => {
                let path = rest.to_owned();
                Ok(Request { path, ..request })
            }
            _ => Err(Response::text(404, "there is nothing here; open the address that was printed")),
        }
    }
}

/// Compares two texts in a time that does not reveal the length of their common prefix.
fn same(a: &str, b: &str) -> bool {
    a.len() == b.len() && a.bytes().zip(b.bytes()).fold(0, |differs, (a, b)| differs | (a ^ b)) == 0
}

/// Parses a request; `None` while it is incomplete.
///
/// # Errors
/// The error response to a malformed or oversized request.
pub(super) fn parse(bytes: &[u8]) -> Result<Option<Request>, Response> {
    let too_long = || Response::text(413, "the head of the request is too long");
    let searched = &bytes[..bytes.len().min(HEAD_BYTES)];
    let Some(end) = searched.windows(4).position(|four| four == b"\r\n\r\n") else {
        return if bytes.len() >= HEAD_BYTES { Err(too_long()) } else { Ok(None) };
    };
    let head = end + 4;
    let (mut request, length) = parsed(&bytes[..head])?;
    if length > BODY_BYTES {
        return Err(Response::text(413, "the request is too long"));
    }
    let Some(body) = bytes.get(head..head + length) else { return Ok(None) };
    std::str::from_utf8(body).map_err(|_| bad())?.clone_into(&mut request.body);
    Ok(Some(request))
}

fn bad() -> Response {
    Response::text(400, "that is no request")
}

/// The path below this token in the head of a request, if the request is admitted: for the fuzzer.
pub(super) fn admitted(head: &[u8], port: u16, token: &str) -> Option<String> {
    let (request, _) = parsed(head).ok()?;
    let gate = Gate { port, token: token.to_owned() };
    gate.admit(request).ok().map(|request| request.path)
}

/// Parses the head of a request and the length of its body.
fn parsed(head: &[u8]) -> Result<(Request, usize), Response> {
    let head = std::str::from_utf8(head).map_err(|_| bad())?;
    let mut lines = head.split("\r\n");
    let mut words = lines.next().unwrap_or_default().split(' ');
    let (Some(method), Some(path), Some("HTTP/1.1" | "HTTP/1.0"), None) =
        (words.next(), words.next(), words.next(), words.next())
    else {
        return Err(bad());
    };
    let mut request = Request { method: method.to_owned(), path: path.to_owned(), ..Request::default() };
    let mut length = None;
    for line in lines.take_while(|line| !line.is_empty()) {
        let (name, value) = line.split_once(':').ok_or_else(bad)?;
        let value = value.trim();
        match name.to_ascii_lowercase().as_str() {
            "host" => request.host.push(value.to_ascii_lowercase()),
            "origin" => request.origin.push(value.to_ascii_lowercase()),
            // Digits alone; `+5` is no length.
            "content-length" if length.is_none() && value.bytes().all(|byte| byte.is_ascii_digit()) => {
                length = Some(value.parse().map_err(|_| Response::text(413, "the request is too long"))?);
            }
            // Two lengths or a chunked body make the end of the request ambiguous.
            "content-length" | "transfer-encoding" => return Err(bad()),
            _ => {}
        }
    }
    Ok((request, length.unwrap_or(0)))
}

impl Response {
    fn of(status: u16, kind: &'static str, body: &str) -> Self {
        Self { status, kind, policy: "default-src 'none'".into(), body: body.into() }
    }

    pub(super) fn text(status: u16, text: &str) -> Self {
        Self::of(status, "text/plain; charset=utf-8", text)
    }

    pub(super) fn json(json: &str) -> Self {
        Self::of(200, "application/json", json)
    }

    pub(super) fn page(ServedPage { html, policy }: ServedPage) -> Self {
        Self { status: 200, kind: "text/html; charset=utf-8", policy, body: html }
    }

    /// The head and the body; the connection closes after them.
    pub(super) fn into_parts(self) -> (String, Arc<str>) {
        let Self { status, kind, policy, body } = self;
        let reason = match status {
            200 => "OK",
            202 => "Accepted",
            403 => "Forbidden",
            404 => "Not Found",
            405 => "Method Not Allowed",
            408 => "Request Timeout",
            413 => "Content Too Large",
            _ => "Bad Request",
        };
        let head = format!(
            "HTTP/1.1 {status} {reason}\r\nContent-Type: {kind}\r\nContent-Length: {}\r\nConnection: close\r\nCache-Control: no-store\r\n\
             X-Content-Type-Options: nosniff\r\nReferrer-Policy: no-referrer\r\nCross-Origin-Resource-Policy: same-origin\r\n\
             Content-Security-Policy: {policy}; frame-ancestors 'none'\r\n\r\n",
            body.len()
        );
        (head, body)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn head(text: &str) -> Result<(Request, usize), u16> {
        parsed(text.replace('\n', "\r\n").as_bytes()).map_err(|refusal| refusal.status)
    }

    #[test]
    fn heads_are_read_or_refused() {
        let (request, length) =
            head("POST /t/run HTTP/1.1\nHost: 127.0.0.1:9\ncontent-length: 3\n\n").unwrap();
        assert_eq!((request.method.as_str(), request.path.as_str(), length), ("POST", "/t/run", 3));
        for wrong in [
            "",
            "GET /\n\n",
            "GET  / HTTP/1.1\n\n",
            "GET / HTTP/2\n\n",
            "GET / HTTP/1.1\nno colon\n\n",
            "POST / HTTP/1.1\nContent-Length: 3\nContent-Length: 3\n\n",
            "POST / HTTP/1.1\nContent-Length: +3\n\n",
            "POST / HTTP/1.1\nTransfer-Encoding: chunked\n\n",
        ] {
            assert_eq!(head(wrong), Err(400), "{wrong}");
        }
        assert_eq!(head("POST / HTTP/1.1\nContent-Length: 99999999999999999999999\n\n"), Err(413));
    }

    /// A request parses the same however it is split, and bounds apply as soon as they are exceeded.
    #[test]
    fn requests_arrive_in_pieces() {
        let whole = b"POST /t/run HTTP/1.1\r\nHost: 127.0.0.1:9\r\nContent-Length: 3\r\n\r\n7,8 and more";
        let end = whole.len() - " and more".len();
        for cut in 0..whole.len() {
            let result = parse(&whole[..cut]).map_err(|refusal| refusal.status).unwrap();
            assert_eq!(result.map(|request| request.body), (cut >= end).then(|| "7,8".to_owned()), "{cut}");
        }
        let status = |bytes: &[u8]| parse(bytes).unwrap_err().status;
        assert_eq!(status(&[b'x'; HEAD_BYTES]), 413);
        assert_eq!(
            status(format!("GET / HTTP/1.1\r\nX: {}\r\n\r\n", "x".repeat(HEAD_BYTES)).as_bytes()),
            413
        );
        assert_eq!(status(b"POST / HTTP/1.1\r\nContent-Length: 257\r\n\r\n"), 413);
        assert_eq!(status(b"POST / HTTP/1.1\r\nContent-Length: 1\r\n\r\n\xff"), 400);
        assert_eq!(status(b"\x16\x03\x01\x00\r\n\r\n"), 400);
    }

    #[test]
    fn only_this_machine_this_page_and_the_token_are_let_in() {
        let gate = Gate { port: 9, token: "abc".to_owned() };
        let ask = |path: &str, host: &[&str], origin: &[&str]| {
            let own = |list: &[&str]| list.iter().map(|&text| text.to_owned()).collect();
            let request =
                Request { path: path.to_owned(), host: own(host), origin: own(origin), ..Request::default() };
            gate.admit(request).map(|request| request.path).map_err(|refusal| refusal.status)
        };
        let here = &["127.0.0.1:9"][..];
        assert_eq!(ask("/abc/", here, &[]), Ok(String::new()));
        assert_eq!(ask("/abc/run", &["localhost:9"], &["http://localhost:9"]), Ok("run".to_owned()));
        // Below the token, paths are compared and never opened.
        assert_eq!(ask("/abc/../../etc/passwd", here, &[]), Ok("../../etc/passwd".to_owned()));
        let head = |path: &str| format!("GET {path} HTTP/1.1\r\nHost: localhost:9\r\n\r\n");
        assert_eq!(admitted(head("/abc/run").as_bytes(), 9, "abc"), Some("run".to_owned()));
        assert_eq!(admitted(head("/abd/run").as_bytes(), 9, "abc"), None);
        for path in ["/", "/abc", "/abd/", "/ab/", "abc/", "//abc/", "/abc%2f/", "http://127.0.0.1:9/abc/"] {
            assert_eq!(ask(path, here, &[]), Err(404), "{path}");
        }
        for host in [&[][..], &["127.0.0.1"], &["example.org:9"], &["127.0.0.1:9", "127.0.0.1:9"]] {
            assert_eq!(ask("/abc/", host, &[]), Err(403), "{host:?}");
        }
        for origin in ["null", "http://example.org", "https://127.0.0.1:9", "http://127.0.0.1:90"] {
            assert_eq!(ask("/abc/", here, &[origin]), Err(403), "{origin}");
        }
    }
}
