//! Pages, through the real binary: the file of `report`, and the server of `view`, queried over plain
//! sockets.

use super::{catchment, run};
use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Stdio};
use std::time::Duration;

const DESIGN: &str = "name = \"a </script> V\"\n[connector]\nfamily = \"v-face\"\nwidth = 50.0\nunit = \"mm\"\n[errors]\nx = \"30 mm\"\n";

fn home() -> tempfile::TempDir {
    let home = tempfile::tempdir().unwrap();
    fs::write(home.path().join("v.toml"), DESIGN).unwrap();
    home
}

#[test]
fn a_page_of_a_result_is_that_of_its_design() {
    let home = home();
    let sample = ["--resolution", "8", "--samples", "300", "--seed", "5"];
    let alone = ["report", "v.toml", "-o", "fresh.html", "--leave-out", "slices,jams,window"];
    for args in [
        [&["run", "v.toml", "-o", "out"][..], &sample].concat(),
        vec!["report", "out", "-o", "stored.html", "--leave-out", "jams,window"],
        [&alone[..], &sample].concat(),
    ] {
        let printed = run(home.path(), &args);
        assert!(printed.starts_with("exit 0\n"), "{printed}");
    }
    let [stored, fresh] =
        ["stored.html", "fresh.html"].map(|name| fs::read_to_string(home.path().join(name)).unwrap());
    assert!(stored == fresh && stored.starts_with("<!doctype html>"));
    assert!(
        stored.len() < 5_000_000 && stored.contains("id=\"motions\"") && !stored.contains("a </script> V")
    );
    // An existing file is replaced only with `--force`.
    let printed = run(home.path(), &["report", "out", "-o", "stored.html"]);
    assert!(printed.starts_with("exit 2\n") && printed.contains("--force replaces it"), "{printed}");
    // A stored result has its sample.
    for option in ["--samples=300", "--budget=1s", "--tolerance=1%", "--seed=5"] {
        let printed = run(home.path(), &["report", "out", "-o", "other.html", option]);
        let refusal =
            format!("{}: out is a result, which has been decided", option.split_once('=').unwrap().0);
        assert!(printed.starts_with("exit 2\n") && printed.contains(&refusal), "{printed}");
    }
}

/// A setting that is changed for a page applies to everything in it.
#[test]
fn a_page_uses_the_requested_errors_and_friction() {
    let home = home();
    let changes = ["--free", "x", "--cor", "0.2", "--friction", "0.1", "--resolution", "40"];
    let printed = run(home.path(), &[&["run", "v.toml", "--jams", "-o", "out"], &changes[..]].concat());
    assert!(printed.starts_with("exit 0\n"), "{printed}");
    let fresh = [&["report", "v.toml", "-o", "fresh.html", "--leave-out", "window"], &changes[..]].concat();
    let printed = run(home.path(), &fresh);
    assert!(printed.starts_with("exit 0\n"), "{printed}");
    // A page of a stored result shows the data it holds and lists the data it lacks.
    let printed = run(home.path(), &["report", "out", "-o", "stored.html"]);
    assert!(
        printed.starts_with("exit 0\n") && printed.contains("`catchment run` with --window stores more"),
        "{printed}"
    );
    let data = |name: &str| -> serde_json::Value {
        let page = fs::read_to_string(home.path().join(name)).unwrap();
        let data = page.split("id=\"data\">").nth(1).unwrap().split("</script>").next().unwrap();
        serde_json::from_str(data).unwrap()
    };
    let [stored, fresh] = ["stored.html", "fresh.html"].map(data);
    assert_eq!(stored["jams"]["jams"], fresh["jams"]["jams"]);
    for data in [stored, fresh] {
        assert_eq!(data["report"]["design"]["alignment"]["free"], serde_json::json!(["x"]));
        assert_eq!(data["jams"]["settings"]["friction"], 0.1);
    }
}

/// A server and its address; it ends with the test.
struct Server {
    child: Child,
    port: u16,
    token: String,
}

impl Server {
    fn start(folder: &Path) -> Self {
        Self::over(folder, "6")
    }

    fn over(folder: &Path, resolution: &str) -> Self {
        let mut child = catchment(folder)
            .args(["view", "v.toml", "--resolution", resolution, "--leave-out", "jams,window"])
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let mut line = String::new();
        BufReader::new(child.stdout.take().unwrap()).read_line(&mut line).unwrap();
        let rest = line.trim().strip_prefix("http://127.0.0.1:").unwrap();
        let (port, token) = rest.split_once('/').unwrap();
        Self { child, port: port.parse().unwrap(), token: token.trim_end_matches('/').to_owned() }
    }

    /// Sends bytes unchanged and returns the response.
    fn raw(&self, bytes: &[u8]) -> String {
        let mut stream = TcpStream::connect(("127.0.0.1", self.port)).unwrap();
        stream.set_read_timeout(Some(Duration::from_mins(1))).unwrap();
        // The server may refuse before it has read the whole request.
        let _ = stream.write_all(bytes);
        let mut text = Vec::new();
        let _ = stream.read_to_end(&mut text);
        String::from_utf8_lossy(&text).into_owned()
    }

    fn request(&self, method: &str, path: &str, more: &str, body: &str) -> String {
        let Self { port, token, .. } = self;
        let length = body.len();
        self.raw(
            format!(
                "{method} /{token}/{path} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nContent-Length: {length}\r\n{more}\r\n{body}"
            )
            .as_bytes(),
        )
    }

    fn wait(&self) {
        while self.request("GET", "progress", "", "").contains("\"running\"") {
            std::thread::sleep(Duration::from_millis(50));
        }
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

#[test]
fn the_page_is_served_and_computed_again_from_the_file_as_it_is_now() {
    let home = home();
    let server = Server::start(home.path());
    assert_eq!(server.token.len(), 32);
    server.wait();
    let page = server.request("GET", "", "", "");
    assert!(page.starts_with("HTTP/1.1 200 OK\r\n") && page.contains("\"served\":true"), "{}", &page[..300]);
    assert!(page.contains("Cache-Control: no-store") && page.contains("frame-ancestors 'none'"));
    assert!(page.contains("script-src 'sha256-") && page.contains("connect-src 'self'"));
    assert!(!page.split("\r\n\r\n").next().unwrap().contains("unsafe-inline"));
    assert!(page.contains("\"cells\":6"));
    fs::write(home.path().join("v.toml"), DESIGN.replace("a </script> V", "changed")).unwrap();
    assert!(server.request("POST", "run", "", "7").starts_with("HTTP/1.1 202"));
    server.wait();
    let page = server.request("GET", "", "", "");
    assert!(page.contains("<title>changed ·") && page.contains("\"cells\":7"));
    // A defect of the design is reported, and the previous page stays.
    fs::write(home.path().join("v.toml"), "[connector]\nfamily = \"w-face\"\n").unwrap();
    assert!(server.request("POST", "run", "", "").starts_with("HTTP/1.1 202"));
    server.wait();
    let progress = server.request("GET", "progress", "", "");
    assert!(progress.contains("\"failed\"") && progress.contains("w-face"), "{progress}");
    assert!(server.request("GET", "", "", "").contains("<title>changed ·"));
    assert!(server.request("POST", "run", "", "many").starts_with("HTTP/1.1 400"));
}

/// The server serves the newest request, whether the older ones have ended or not.
#[test]
fn a_running_computation_is_replaced_by_a_newer_one() {
    let home = home();
    let server = Server::over(home.path(), "2000");
    for cells in ["1999", "7"] {
        let printed = server.request("POST", "run", "", cells);
        assert!(printed.starts_with("HTTP/1.1 202"), "{printed}");
    }
    server.wait();
    let page = server.request("GET", "", "", "");
    assert!(page.contains("\"cells\":7"), "{}", &page[..300]);
}

/// Clients whose requests never end, that read nothing, and that stay to the end of the test.
#[test]
fn two_hundred_slow_clients_do_not_block_others() {
    let home = home();
    let server = Server::start(home.path());
    server.wait();
    let mut slow = Vec::new();
    for k in 0..200 {
        let mut stream = TcpStream::connect(("127.0.0.1", server.port)).unwrap();
        // Some clients send nothing, some send part of a request, some request the page and do not read it.
        let own = format!("GET /{}/ HTTP/1.1\r\nHost: 127.0.0.1:{}\r\n\r\n", server.token, server.port);
        let part = ["", &own[..9], &own[..own.len() - 2], &own][k % 4];
        let _ = stream.write_all(part.as_bytes());
        slow.push(stream);
    }
    for _ in 0..20 {
        let page = server.request("GET", "", "", "");
        assert!(page.starts_with("HTTP/1.1 200 OK\r\n") && page.ends_with("</html>\n"), "{}", &page[..200]);
        assert!(server.request("GET", "progress", "", "").contains("\"ready\""));
    }
}

#[test]
fn unauthorized_requests_are_refused() {
    let home = home();
    let server = Server::start(home.path());
    let Server { port, token, .. } = &server;
    let status = |text: &str| text.split(' ').nth(1).unwrap_or("closed").to_owned();
    let get = |path: &str, host: &str, more: &str| {
        status(&server.raw(format!("GET {path} HTTP/1.1\r\nHost: {host}\r\n{more}\r\n").as_bytes()))
    };
    let here = format!("127.0.0.1:{port}");
    let own = format!("/{token}/");
    assert_eq!(get(&own, &here, ""), "200");
    assert_eq!(get(&own, &here, &format!("Origin: http://{here}\r\n")), "200");
    // No token, a wrong token, another host name that resolves to this address, another origin.
    assert_eq!(get("/", &here, ""), "404");
    assert_eq!(get(&format!("/{}/", "0".repeat(32)), &here, ""), "404");
    assert_eq!(get(&own, &format!("example.org:{port}"), ""), "403");
    assert_eq!(get(&own, &here, "Origin: http://example.org\r\n"), "403");
    assert_eq!(get(&own, &here, "Origin: null\r\n"), "403");
    // The server compares a path with its known names and never opens it as a file.
    for path in ["../v.toml", "../../../../etc/passwd", "%2e%2e/v.toml", "v.toml", "..\\v.toml"] {
        assert_eq!(get(&format!("{own}{path}"), &here, ""), "404", "{path}");
    }
    assert_eq!(get(&format!("/{token}/../v.toml"), &here, ""), "404");
    // A head that is too long, a body that is too long, bytes that are not a request.
    assert_eq!(get(&own, &here, &format!("X: {}\r\n", "x".repeat(20_000))), "413");
    assert_eq!(status(&server.request("POST", "run", "", &"1".repeat(300))), "413");
    assert_eq!(status(&server.raw(b"\x16\x03\x01\x00\r\n\r\n")), "400");
    assert_eq!(status(&server.request("DELETE", "run", "", "")), "405");
    // The server still responds.
    assert_eq!(get(&own, &here, ""), "200");
}

#[cfg(unix)]
#[test]
fn ctrl_c_ends_it_also_while_it_computes() {
    let home = home();
    let mut server = Server::start(home.path());
    let ended =
        std::process::Command::new("kill").args(["-INT", &server.child.id().to_string()]).status().unwrap();
    assert!(ended.success());
    assert_eq!(server.child.wait().unwrap().code(), Some(130));
    assert!(TcpStream::connect(("127.0.0.1", server.port)).is_err());
}
