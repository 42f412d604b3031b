//! `catchment view`: the page of a design, served to this machine, computed again on demand.

mod desk;
mod http;

use super::report::MadeArgs;
use crate::args::DesignArgs;
use crate::exec_args::ExecArgs;
use crate::exit::ExitStatus;
use crate::failure::Failure;
use crate::output::to_stdout;
use crate::signals;
use clap::Args;
use desk::Desk;
use http::{Request, Response};
use std::hash::{BuildHasher, RandomState};
use std::io;
use std::net::{Ipv4Addr, TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::Duration;

/// The page of a design in your browser, computed again whenever you ask for it
///
/// Serves the page of `catchment report` to this machine alone, under an address that holds a random token, until Ctrl-C. "compute again" in the
/// page reads the design file again, so that it can be changed beside it.
#[derive(Debug, Args)]
#[command(after_long_help = "Examples:\n  \
    catchment view design.toml                          prints the address to open\n  \
    catchment view design.toml --resolution 20 --leave-out window\n  \
    catchment view design.toml --port 8080\n\n\
    Nothing is written. Whoever does not know the token, comes by another name of this machine, or from another page, is refused.")]
pub(crate) struct ViewArgs {
    #[command(flatten)]
    design: DesignArgs,
    #[command(flatten)]
    made: MadeArgs,
    /// Port on 127.0.0.1; 0 for one that is free
    #[arg(long, value_name = "PORT", default_value_t = 0)]
    port: u16,
    #[command(flatten)]
    exec: ExecArgs,
}

/// How often it is asked whether to stop.
const PATIENCE: Duration = Duration::from_millis(30);
/// Connections that are answered at a time; a browser opens six.
const MOST_CONNECTIONS: usize = 32;

/// What the head of a request asks for below this token, if it is let in.
pub(crate) fn admitted(head: &[u8], port: u16, token: &str) -> Option<String> {
    http::admitted(head, port, token)
}

pub(crate) fn run(args: &ViewArgs) -> Result<ExitStatus, Failure> {
    // What is wrong with the design is told here, where it has its place in the file.
    args.design.problem()?;
    let running = args.exec.start()?;
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, args.port)).map_err(|error| {
        let help = "name another --port, or none".to_owned();
        Failure::with_help(format!("cannot listen on 127.0.0.1:{}: {error}", args.port), Some(help))
    })?;
    listener.set_nonblocking(true)?;
    let port = listener.local_addr()?.port();
    let token = token();
    let desk = Arc::new(Desk::new(args.design.clone(), args.made.clone(), args.exec.threads()));
    desk.start(None);
    to_stdout(&format!("http://127.0.0.1:{port}/{token}/\n"))?;
    let gate = Arc::new(http::Gate { port, token });
    let stop = running.exec.cancel_flag();
    while !stop.load(Ordering::Relaxed) {
        match listener.accept() {
            // Whoever comes while so many are answered is let go.
            Ok((stream, _)) if Arc::strong_count(&gate) <= MOST_CONNECTIONS => {
                let (gate, desk) = (Arc::clone(&gate), Arc::clone(&desk));
                // Where there is no thread the connection is closed, and the browser tries again.
                let _ = std::thread::Builder::new().spawn(move || answer(stream, &gate, &desk));
            }
            Ok(_) => {}
            Err(error) if error.kind() == io::ErrorKind::WouldBlock => std::thread::sleep(PATIENCE),
            // One that was given up before it was taken.
            Err(_) => std::thread::sleep(PATIENCE),
        }
    }
    desk.stop();
    drop(running);
    Ok(signals::received().unwrap_or(ExitStatus::Done))
}

/// 128 random bits, as the system gives them to every process for its hash tables.
fn token() -> String {
    let bits = || RandomState::new().hash_one(std::process::id());
    format!("{:016x}{:016x}", bits(), bits())
}

/// One request, one answer.
fn answer(mut stream: TcpStream, gate: &http::Gate, desk: &Arc<Desk>) {
    let response = match http::read(&mut stream).and_then(|request| gate.admit(request)) {
        Ok(request) => respond(&request, desk),
        Err(refusal) => refusal,
    };
    // Whoever asked may be gone.
    let _ = response.write(&mut stream);
}

fn respond(request: &Request, desk: &Arc<Desk>) -> Response {
    match (request.method.as_str(), request.path.as_str()) {
        ("GET", "") => Response::page(desk.page()),
        ("GET", "progress") => Response::json(desk.progress()),
        ("POST", "run") => match desk.ask(&request.body) {
            Ok(()) => Response::text(202, "started"),
            Err(why) => Response::text(400, &why),
        },
        (_, "" | "progress" | "run") => Response::text(405, "this address is not asked that way"),
        _ => Response::text(404, "there is nothing here"),
    }
}
