//! One page on this machine's own address, for its browsers alone.

use crate::failure::Failure;
use crate::shared::print;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::{Ipv4Addr, TcpListener, TcpStream};
use std::time::Duration;

/// How long a browser may take to ask, or to read what it is told.
const PATIENCE: Duration = Duration::from_secs(10);
/// Bytes of a request that are read.
const MOST_BYTES: u64 = 1 << 14;

/// Takes a port; 0 is any that is free.
pub fn bind(port: u16) -> Result<TcpListener, Failure> {
    TcpListener::bind((Ipv4Addr::LOCALHOST, port))
        .map_err(|e| Failure::new(format!("--port {port}: {e}; give another one, or 0 for any")))
}

/// Serves the page until the program is ended.
pub fn forever(listener: &TcpListener, page: &str) -> Result<(), Failure> {
    let port = listener.local_addr()?.port();
    print(&format!("http://127.0.0.1:{port}/ shows it as long as this program runs; end it by Ctrl-C\n"))?;
    for stream in listener.incoming() {
        // A browser that goes away is asked nothing more; the next one is served.
        let _ = stream.and_then(|stream| answer(stream, page));
    }
    Ok(())
}

/// Answers one request.
fn answer(mut stream: TcpStream, page: &str) -> std::io::Result<()> {
    stream.set_read_timeout(Some(PATIENCE))?;
    stream.set_write_timeout(Some(PATIENCE))?;
    let mut lines = BufReader::new(stream.try_clone()?.take(MOST_BYTES)).lines();
    let request = lines.next().transpose()?.unwrap_or_default();
    // The request ends with an empty line.
    while lines.next().transpose()?.is_some_and(|line| !line.is_empty()) {}
    let mut words = request.split(' ');
    let (status, kind, body) = match (words.next(), words.next()) {
        (Some("GET" | "HEAD"), Some("/" | "/index.html")) => ("200 OK", "text/html; charset=utf-8", page),
        (Some("GET" | "HEAD"), _) => ("404 Not Found", "text/plain", "the page is at /\n"),
        _ => ("405 Method Not Allowed", "text/plain", "the page is only read\n"),
    };
    let length = body.len();
    let head = format!(
        "HTTP/1.1 {status}\r\nContent-Type: {kind}\r\nContent-Length: {length}\r\nCache-Control: \
         no-store\r\nX-Content-Type-Options: nosniff\r\nConnection: close\r\n\r\n"
    );
    stream.write_all(head.as_bytes())?;
    if !request.starts_with("HEAD") {
        stream.write_all(body.as_bytes())?;
    }
    stream.flush()
}
