//! The server: a socket on the loopback address, and the connections to it.
use crate::api::router;
use crate::schema::Start;
use crate::structure::Opened;
use axum::Router;
use hyper::server::conn::http1;
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::service::TowerToHyperService;
use std::io;
use std::net::{Ipv4Addr, TcpListener};
use std::sync::Arc;
use std::time::Duration;
use tokio::net::TcpStream;
use tokio::sync::{Notify, Semaphore};
use tokio_io_timeout::TimeoutStream;

/// Connections open at one time; a browser has six. Others wait until one is closed.
const MOST_CONNECTIONS: usize = 64;
/// How long the head of a request may take to arrive, and a connection may be idle.
const HEAD_WITHIN: Duration = Duration::from_secs(10);
/// How long the client may take to accept a part of an answer.
const WRITE_WITHIN: Duration = Duration::from_secs(30);
/// The largest head of a request.
const LARGEST_HEAD: usize = 32 << 10;
/// How long to wait where the system can not accept a connection, such as for want of file handles.
const RETRY_AFTER: Duration = Duration::from_millis(50);

/// A server that has its port, and serves once it is told to.
pub struct Server {
    listener: TcpListener,
    port: u16,
    start: Start,
    opened: Option<Opened>,
    stop: Stop,
}

/// Ends a server from any thread.
#[derive(Clone, Default)]
pub struct Stop(Arc<Notify>);

impl Stop {
    /// Ends it: the connections are closed, and work that is under way is dropped.
    pub fn now(&self) {
        self.0.notify_one();
    }
}

impl Server {
    /// Takes a port of the loopback address, any free one for 0, to serve the page that begins with
    /// this case.
    ///
    /// # Errors
    /// Where the port is taken or not ours to take.
    pub fn bind(port: u16, start: Start) -> io::Result<Self> {
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port))?;
        listener.set_nonblocking(true)?;
        Ok(Self {
            port: listener.local_addr()?.port(),
            listener,
            start,
            opened: None,
            stop: Stop::default(),
        })
    }

    /// The same with the page of a structure in front.
    #[must_use]
    pub fn opening(self, structure: Opened) -> Self {
        let opened = Some(structure);
        Self { opened, ..self }
    }

    /// Where the page is.
    pub fn address(&self) -> String {
        format!("http://127.0.0.1:{}/", self.port)
    }

    /// What ends it.
    pub fn stop(&self) -> Stop {
        self.stop.clone()
    }

    /// Serves until it is stopped.
    ///
    /// # Errors
    /// Where the system gives no threads or takes the socket away.
    pub fn serve(self) -> io::Result<()> {
        let mut runtime = tokio::runtime::Builder::new_multi_thread();
        let runtime = runtime
            .worker_threads(2)
            .enable_io()
            .enable_time()
            .build()?;
        let served = runtime.block_on(self.accept());
        runtime.shutdown_background();
        served
    }

    async fn accept(self) -> io::Result<()> {
        let router = router(self.start, self.opened, self.port);
        let listener = tokio::net::TcpListener::from_std(self.listener)?;
        let permits = Arc::new(Semaphore::new(MOST_CONNECTIONS));
        let accepting = async {
            while let Ok(permit) = Arc::clone(&permits).acquire_owned().await {
                let Ok((stream, _)) = listener.accept().await else {
                    tokio::time::sleep(RETRY_AFTER).await;
                    continue;
                };
                let served = serve_connection(stream, router.clone());
                tokio::spawn(async move {
                    served.await;
                    drop(permit);
                });
            }
        };
        tokio::select! {
            () = accepting => {}
            () = self.stop.0.notified() => {}
        }
        Ok(())
    }
}

/// Answers the requests of one connection.
async fn serve_connection(stream: TcpStream, router: Router) {
    // A line of a map goes out as soon as it is there.
    let _ = stream.set_nodelay(true);
    let mut stream = TimeoutStream::new(stream);
    stream.set_write_timeout(Some(WRITE_WITHIN));
    let served = http1::Builder::new()
        .timer(TokioTimer::new())
        .header_read_timeout(HEAD_WITHIN)
        .max_buf_size(LARGEST_HEAD)
        .serve_connection(
            TokioIo::new(Box::pin(stream)),
            TowerToHyperService::new(router),
        );
    // However it ends, it ends this connection only.
    let _ = served.await;
}
