//! `catchment view`: serves the page of a design on this machine and recomputes it on demand.

mod http;
mod live_page;
mod server;

use super::report::MadeArgs;
use crate::args::DesignArgs;
use crate::exec_args::ExecArgs;
use crate::exit::ExitStatus;
use crate::failure::Failure;
use crate::output::to_stdout;
use crate::signals;
use catchment::exec::Exec;
use catchment::landscape::Resolution;
use catchment::terminal::printable;
use clap::Args;
use http::{Request, Response};
use live_page::{LivePage, ServedPage};
use std::hash::{BuildHasher, RandomState};
use std::net::{Ipv4Addr, TcpListener};
use std::sync::Arc;

/// Serve the interactive page and recompute on demand
///
/// Serves the page of `catchment report` to this machine only, under an address with a random token, until Ctrl-C. "compute again" in the
/// page reads the design file again, so edit it beside the page. A newer request cancels a computation that still runs.
#[derive(Debug, Args)]
#[command(after_long_help = "\
Examples:
  catchment view design.toml
      prints the address to open
  catchment view design.toml --resolution 20 --leave-out window
  catchment view design.toml --port 8080

Nothing is written. Requests without the token, from another page, or by
another name of this machine are refused.")]
pub(crate) struct ViewArgs {
    #[command(flatten)]
    design: DesignArgs,
    #[command(flatten)]
    made: MadeArgs,
    /// Port on 127.0.0.1; 0 takes any free port
    #[arg(long, value_name = "PORT", default_value_t = 0)]
    port: u16,
    #[command(flatten)]
    exec: ExecArgs,
}

/// The path below this token in the head of a request, if the request is admitted.
pub(crate) fn admitted(head: &[u8], port: u16, token: &str) -> Option<String> {
    http::admitted(head, port, token)
}

pub(crate) fn run(args: &ViewArgs) -> Result<ExitStatus, Failure> {
    // Report the defects of the design here, with their place in the file.
    args.design.problem()?;
    let running = args.exec.start()?;
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, args.port)).map_err(|error| {
        let help = "name another --port, or none".to_owned();
        Failure::with_help(format!("cannot listen on 127.0.0.1:{}: {error}", args.port), Some(help))
            .ends(ExitStatus::NotComputed)
    })?;
    let port = listener.local_addr()?.port();
    let token = token();
    let (design, made) = (args.design.clone(), args.made.clone());
    let compute = move |resolution: Option<Resolution>, exec: &Exec| {
        page(&design, &made.over(resolution), exec).map_err(|failure| message(&failure))
    };
    let desk = Arc::new(LivePage::new(args.exec.threads(), compute));
    desk.start(None);
    to_stdout(&format!("http://127.0.0.1:{port}/{token}/\n"))?;
    let gate = http::Gate { port, token };
    let respond = |request| match gate.admit(request) {
        Ok(request) => respond(&request, &desk),
        Err(refusal) => refusal,
    };
    let served = server::serve(&listener, &running.exec.cancel_flag(), &respond);
    desk.close();
    drop(running);
    served?;
    Ok(signals::received().unwrap_or(ExitStatus::Done))
}

/// The page of the design in its current file.
fn page(design: &DesignArgs, made: &MadeArgs, exec: &Exec) -> Result<ServedPage, Failure> {
    let parts = made.parts(&design.problem()?, exec)?;
    let mut page = parts.page();
    page.is_served = true;
    Ok(ServedPage { policy: page.policy().into(), html: page.html(exec)?.into() })
}

/// The text of a failure on a page.
fn message(failure: &Failure) -> String {
    failure.text().lines().map(printable).collect::<Vec<_>>().join("\n")
}

/// 128 random bits, from the system's seed for hash tables.
fn token() -> String {
    let bits = || RandomState::new().hash_one(std::process::id());
    format!("{:016x}{:016x}", bits(), bits())
}

fn respond(request: &Request, desk: &Arc<LivePage>) -> Response {
    match (request.method.as_str(), request.path.as_str()) {
        ("GET", "") => Response::page(desk.page()),
        ("GET", "progress") => Response::json(&desk.progress()),
        ("POST", "run") => match desk.request(&request.body) {
            Ok(true) => Response::text(202, "started in place of the one that was being computed"),
            Ok(false) => Response::text(202, "started"),
            Err(why) => Response::text(400, &why),
        },
        (_, "" | "progress" | "run") => Response::text(405, "this address does not take that method"),
        _ => Response::text(404, "there is nothing here"),
    }
}
