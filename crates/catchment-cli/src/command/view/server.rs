//! Serves all connections on one thread; no connection blocks another.
//!
//! ```text
//!   accept ──▶ Reading ──parse, admit, respond──▶ Writing ──▶ Draining ──▶ closed
//!                 5 s                              60 s        2 s, discards further input
//! ```
//!
//! Sockets do not block. At most [`MOST_CONNECTIONS`] are open. A new connection replaces the oldest one
//! without a complete request, so that idle or slow clients do not delay other clients. Responses need no
//! computation: the page already exists.

use super::http::{Request, Response, parse};
use std::io::{self, Read, Write};
use std::net::{Shutdown, TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Largest number of open connections; a browser opens six.
const MOST_CONNECTIONS: usize = 128;
/// Time limits for receiving a request, sending a response, and the client's close.
const READING: Duration = Duration::from_secs(5);
const WRITING: Duration = Duration::from_mins(1);
const DRAINING: Duration = Duration::from_secs(2);
/// Pause between two polls if no socket was ready.
const PAUSE: Duration = Duration::from_millis(10);
/// Bytes per read.
const PIECE: usize = 4096;

/// The socket operations that a connection needs.
trait Stream: Read + Write {
    /// Closes the sending direction.
    fn finish(&self);
}

impl Stream for TcpStream {
    fn finish(&self) {
        // The client may already be gone.
        let _ = self.shutdown(Shutdown::Write);
    }
}

enum Phase {
    /// The received part of a request.
    Reading(Vec<u8>),
    /// A response, and the number of its bytes sent.
    Writing { head: String, body: Arc<str>, sent: usize },
    /// The response is sent. An immediate close would reset a client that still sends, before it has read the
    /// response.
    Draining,
}

struct Connection<S> {
    stream: S,
    phase: Phase,
    until: Instant,
}

/// Whether a step made progress or waits for the client.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Step {
    Advanced,
    Waiting,
    Closed,
}

impl<S: Stream> Connection<S> {
    fn new(stream: S, now: Instant) -> Self {
        Self { stream, phase: Phase::Reading(Vec::new()), until: now + READING }
    }

    fn write(&mut self, response: Response, now: Instant) {
        let (head, body) = response.into_parts();
        (self.phase, self.until) = (Phase::Writing { head, body, sent: 0 }, now + WRITING);
    }

    /// Reads or writes once, as much as is ready.
    fn step(&mut self, now: Instant, respond: &dyn Fn(Request) -> Response) -> Step {
        let is_late = now >= self.until;
        let done = match &mut self.phase {
            Phase::Reading(_) if is_late => {
                self.write(Response::text(408, "the request took too long"), now);
                return Step::Advanced;
            }
            _ if is_late => return Step::Closed,
            Phase::Reading(bytes) => {
                let mut piece = [0; PIECE];
                match self.stream.read(&mut piece) {
                    // End of input: the request stays incomplete.
                    Ok(0) => return Step::Closed,
                    Ok(count) => {
                        bytes.extend_from_slice(&piece[..count]);
                        match parse(bytes) {
                            Ok(None) => {}
                            Ok(Some(request)) => self.write(respond(request), now),
                            Err(refusal) => self.write(refusal, now),
                        }
                        Ok(())
                    }
                    Err(error) => Err(error),
                }
            }
            Phase::Writing { head, body, sent } => {
                let left = match sent.checked_sub(head.len()) {
                    Some(of_body) => &body.as_bytes()[of_body..],
                    None => &head.as_bytes()[*sent..],
                };
                match self.stream.write(left) {
                    Ok(count) => {
                        *sent += count;
                        if *sent == head.len() + body.len() {
                            self.stream.finish();
                            (self.phase, self.until) = (Phase::Draining, now + DRAINING);
                        }
                        Ok(())
                    }
                    Err(error) => Err(error),
                }
            }
            Phase::Draining => match self.stream.read(&mut [0; PIECE]) {
                Ok(0) => return Step::Closed,
                Ok(_) => Ok(()),
                Err(error) => Err(error),
            },
        };
        match done {
            Ok(()) => Step::Advanced,
            Err(error) if error.kind() == io::ErrorKind::Interrupted => Step::Advanced,
            Err(error) if error.kind() == io::ErrorKind::WouldBlock => Step::Waiting,
            Err(_) => Step::Closed,
        }
    }
}

/// The open connections, the oldest first.
struct Connections<S>(Vec<Connection<S>>);

impl<S: Stream> Connections<S> {
    /// Adds a connection and reads its first bytes.
    fn take(&mut self, stream: S, now: Instant, respond: &dyn Fn(Request) -> Response) {
        if self.0.len() >= MOST_CONNECTIONS {
            self.give_up_one();
        }
        let mut connection = Connection::new(stream, now);
        if connection.step(now, respond) != Step::Closed {
            self.0.push(connection);
        }
    }

    /// Closes the oldest connection without a complete request; if all are complete, the oldest of all.
    fn give_up_one(&mut self) {
        let reads = |connection: &Connection<S>| matches!(connection.phase, Phase::Reading(_));
        let oldest = self.0.iter().position(reads).unwrap_or(0);
        if oldest < self.0.len() {
            self.0.remove(oldest);
        }
    }

    /// Advances every connection one step; returns whether any made progress.
    fn step(&mut self, now: Instant, respond: &dyn Fn(Request) -> Response) -> bool {
        let mut advanced = false;
        self.0.retain_mut(|connection| {
            let step = connection.step(now, respond);
            advanced |= step != Step::Waiting;
            step != Step::Closed
        });
        advanced
    }
}

/// Serves until `stop` is set.
///
/// # Errors
/// The listener cannot be made non-blocking.
pub(super) fn serve(
    listener: &TcpListener,
    stop: &AtomicBool,
    respond: &dyn Fn(Request) -> Response,
) -> io::Result<()> {
    listener.set_nonblocking(true)?;
    let mut open = Connections(Vec::new());
    while !stop.load(Ordering::Relaxed) {
        let mut advanced = false;
        // Accept at most this many, then advance the open connections.
        for _ in 0..MOST_CONNECTIONS {
            match listener.accept() {
                Ok((stream, _)) => {
                    advanced = true;
                    if stream.set_nonblocking(true).is_ok() {
                        open.take(stream, Instant::now(), respond);
                    }
                }
                Err(error) if error.kind() == io::ErrorKind::WouldBlock => break,
                // A client that left before it was accepted, or no free file descriptor.
                Err(_) => {
                    open.give_up_one();
                    break;
                }
            }
        }
        advanced |= open.step(Instant::now(), respond);
        if !advanced {
            std::thread::sleep(PAUSE);
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::{Cell, RefCell};
    use std::rc::Rc;

    /// A test client: its unread output, its input, and the largest number of bytes that it reads.
    #[derive(Clone, Default)]
    struct Client(Rc<Pipe>);

    #[derive(Default)]
    struct Pipe {
        sent: RefCell<Vec<u8>>,
        received: RefCell<Vec<u8>>,
        reads: Cell<usize>,
        is_gone: Cell<bool>,
        is_finished: Cell<bool>,
    }

    impl Client {
        fn sending(text: &str, reads: usize) -> Self {
            let client = Self::default();
            client.send(text);
            client.0.reads.set(reads);
            client
        }

        fn send(&self, text: &str) {
            self.0.sent.borrow_mut().extend_from_slice(text.as_bytes());
        }

        fn status(&self) -> String {
            let received = String::from_utf8(self.0.received.borrow().clone()).unwrap();
            received.split(' ').nth(1).unwrap_or_default().to_owned()
        }
    }

    impl Read for Client {
        fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
            let mut sent = self.0.sent.borrow_mut();
            if sent.is_empty() {
                return if self.0.is_gone.get() { Ok(0) } else { Err(io::ErrorKind::WouldBlock.into()) };
            }
            let count = sent.len().min(buffer.len());
            buffer[..count].copy_from_slice(&sent[..count]);
            sent.drain(..count);
            Ok(count)
        }
    }

    impl Write for Client {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            let count = bytes.len().min(self.0.reads.get());
            if count == 0 {
                return Err(io::ErrorKind::WouldBlock.into());
            }
            self.0.reads.set(self.0.reads.get() - count);
            self.0.received.borrow_mut().extend_from_slice(&bytes[..count]);
            Ok(count)
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    impl Stream for Client {
        fn finish(&self) {
            self.0.is_finished.set(true);
        }
    }

    const ALL: usize = usize::MAX;
    const REQUEST: &str = "GET /page HTTP/1.1\r\n\r\n";

    fn respond(Request { path, .. }: Request) -> Response {
        Response::json(&path)
    }

    fn settle(open: &mut Connections<Client>, now: Instant) {
        while open.step(now, &respond) {}
    }

    /// With more slow clients than the limit, the oldest are closed first and every complete request gets a
    /// response. No time passes.
    #[test]
    fn slow_clients_hold_up_no_request() {
        let (mut open, now) = (Connections(Vec::new()), Instant::now());
        let slow: Vec<Client> = (0..200).map(|_| Client::sending("GET /page HT", ALL)).collect();
        for client in &slow {
            open.take(client.clone(), now, &respond);
            assert!(open.0.len() <= MOST_CONNECTIONS);
        }
        let good: Vec<Client> = (0..10).map(|_| Client::sending(REQUEST, ALL)).collect();
        for client in &good {
            open.take(client.clone(), now, &respond);
        }
        settle(&mut open, now);
        assert!(good.iter().all(|client| client.status() == "200" && client.0.is_finished.get()));
        assert_eq!(open.0.len(), MOST_CONNECTIONS);
        // One of the remaining slow clients completes its request and gets a response.
        slow[199].send("TP/1.1\r\n\r\n");
        settle(&mut open, now);
        assert_eq!(slow[199].status(), "200");
    }

    /// Clients that do not read delay only themselves.
    #[test]
    fn many_are_answered_at_once() {
        let (mut open, now) = (Connections(Vec::new()), Instant::now());
        let stuck: Vec<Client> = (0..20).map(|_| Client::sending(REQUEST, 10)).collect();
        let good = Client::sending(REQUEST, ALL);
        for client in stuck.iter().chain([&good]) {
            open.take(client.clone(), now, &respond);
        }
        settle(&mut open, now);
        assert_eq!((good.status().as_str(), stuck[0].0.received.borrow().len()), ("200", 10));
        assert!(!stuck[0].0.is_finished.get());
        stuck[0].0.reads.set(ALL);
        settle(&mut open, now);
        assert!(stuck[0].0.is_finished.get());
    }

    /// Time is an argument: the test does not wait.
    #[test]
    fn every_phase_ends() {
        let (mut open, now) = (Connections(Vec::new()), Instant::now());
        let (slow, stuck, rude) =
            (Client::sending("GET", ALL), Client::sending(REQUEST, 0), Client::sending(REQUEST, ALL));
        for client in [&slow, &stuck, &rude] {
            open.take(client.clone(), now, &respond);
        }
        settle(&mut open, now);
        assert_eq!(open.0.len(), 3, "{}", rude.status());
        settle(&mut open, now + READING);
        assert_eq!(slow.status(), "408");
        assert_eq!(open.0.len(), 2, "what was answered and does not close is closed");
        settle(&mut open, now + READING + DRAINING);
        settle(&mut open, now + WRITING);
        assert!(open.0.is_empty());
        assert!(stuck.0.received.borrow().is_empty());
    }

    #[test]
    fn clients_that_go_away_are_forgotten() {
        let (mut open, now) = (Connections(Vec::new()), Instant::now());
        let gone = [Client::sending("GET", ALL), Client::sending(REQUEST, ALL), Client::default()];
        for client in &gone {
            open.take(client.clone(), now, &respond);
            client.0.is_gone.set(true);
        }
        settle(&mut open, now);
        assert!(open.0.is_empty());
    }
}
