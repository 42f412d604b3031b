//! As much of HTTP/1.1 as a page on this machine needs: one request per connection, everything bounded.
//!
//! ```text
//!   bytes ──read──▶ Request ──admit──▶ path below the token     or a refusal:
//!                                                               400 no request · 403 by another name, from another page · 404 no token
//!                                                               408 too slow · 413 too much
//! ```
//!
//! A page elsewhere cannot ask: its requests come with its own Origin, and a name that leads here (DNS rebinding) with its own Host.

use catchment::report::page::POLICY;
use std::io::{self, Read, Write};
use std::net::TcpStream;
use std::time::{Duration, Instant};

/// Most bytes of the head of a request.
const HEAD_BYTES: usize = 16 << 10;
/// Most bytes of its body: a resolution.
const BODY_BYTES: usize = 256;
/// How long a request may take to arrive.
const SLOWEST: Duration = Duration::from_secs(5);

/// What is asked.
#[derive(Debug, Default, PartialEq, Eq)]
pub(super) struct Request {
    pub(super) method: String,
    /// Below the token, once it is admitted.
    pub(super) path: String,
    host: Vec<String>,
    origin: Vec<String>,
    pub(super) body: String,
}

/// An answer.
#[derive(Debug)]
pub(super) struct Response {
    status: u16,
    kind: &'static str,
    body: Vec<u8>,
}

/// Who may ask.
pub(super) struct Gate {
    pub(super) port: u16,
    pub(super) token: String,
}

impl Gate {
    /// Lets a request in, its path below the token.
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

/// Whether two texts are alike, in a time that does not tell how far.
fn same(a: &str, b: &str) -> bool {
    a.len() == b.len() && a.bytes().zip(b.bytes()).fold(0, |differs, (a, b)| differs | (a ^ b)) == 0
}

/// Reads a request, or says what is wrong with it.
pub(super) fn read(stream: &mut TcpStream) -> Result<Request, Response> {
    let end = Instant::now() + SLOWEST;
    // A listener that does not wait may hand that on.
    let _ = stream.set_nonblocking(false);
    let mut bytes = Vec::new();
    let head = loop {
        if let Some(head) = bytes.windows(4).position(|four| four == b"\r\n\r\n") {
            break head + 4;
        }
        if bytes.len() > HEAD_BYTES {
            return Err(Response::text(413, "the head of the request is too long"));
        }
        more(stream, &mut bytes, end)?;
    };
    if head > HEAD_BYTES {
        return Err(Response::text(413, "the head of the request is too long"));
    }
    let (mut request, length) = parsed(&bytes[..head])?;
    if length > BODY_BYTES {
        return Err(Response::text(413, "the request is too long"));
    }
    while bytes.len() < head + length {
        more(stream, &mut bytes, end)?;
    }
    let body = bytes[head..head + length].to_vec();
    request.body = String::from_utf8(body).map_err(|_| bad())?;
    Ok(request)
}

fn bad() -> Response {
    Response::text(400, "that is no request")
}

/// More bytes, while there is time.
fn more(stream: &mut TcpStream, bytes: &mut Vec<u8>, end: Instant) -> Result<(), Response> {
    let left = end.saturating_duration_since(Instant::now());
    let slow = || Response::text(408, "the request took too long");
    if left.is_zero() || stream.set_read_timeout(Some(left)).is_err() {
        return Err(slow());
    }
    let mut some = [0; 4096];
    match stream.read(&mut some) {
        Ok(0) => Err(bad()),
        Ok(count) => {
            bytes.extend_from_slice(&some[..count]);
            Ok(())
        }
        Err(error) if error.kind() == io::ErrorKind::Interrupted => Ok(()),
        Err(_) => Err(slow()),
    }
}

/// What the head of a request asks for below this token, if it is let in: for the fuzzer.
pub(super) fn admitted(head: &[u8], port: u16, token: &str) -> Option<String> {
    let (request, _) = parsed(head).ok()?;
    let gate = Gate { port, token: token.to_owned() };
    gate.admit(request).ok().map(|request| request.path)
}

/// The head of a request, and the length of its body.
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
            // Two lengths, or a body in pieces: what would end where is not clear.
            "content-length" | "transfer-encoding" => return Err(bad()),
            _ => {}
        }
    }
    Ok((request, length.unwrap_or(0)))
}

impl Response {
    pub(super) fn text(status: u16, text: &str) -> Self {
        Self { status, kind: "text/plain; charset=utf-8", body: text.as_bytes().to_vec() }
    }

    pub(super) fn page(page: String) -> Self {
        Self { status: 200, kind: "text/html; charset=utf-8", body: page.into_bytes() }
    }

    pub(super) fn json(json: String) -> Self {
        Self { status: 200, kind: "application/json", body: json.into_bytes() }
    }

    /// Writes it; the connection ends with it.
    pub(super) fn write(&self, stream: &mut TcpStream) -> io::Result<()> {
        let Self { status, kind, body } = self;
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
             Content-Security-Policy: {POLICY}; connect-src 'self'; frame-ancestors 'none'\r\n\r\n",
            body.len()
        );
        stream.set_write_timeout(Some(SLOWEST))?;
        stream.write_all(head.as_bytes())?;
        stream.write_all(body)?;
        stream.flush()
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
        // Below the token names are compared, never opened.
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
