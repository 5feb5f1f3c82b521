//! The server: a socket on the loopback address, and its connections.
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

/// The most connections open at one time; a browser has six. Further ones wait until one is closed.
const MOST_CONNECTIONS: usize = 64;
/// How long the header of a request may take to arrive, and a connection may be idle.
const HEAD_WITHIN: Duration = Duration::from_secs(10);
/// How long the client may take to accept a part of an answer.
const WRITE_WITHIN: Duration = Duration::from_secs(30);
/// The largest header of a request.
const LARGEST_HEAD: usize = 32 << 10;
/// The waiting time if the system can not accept a connection, for example for lack of file
/// handles.
const RETRY_AFTER: Duration = Duration::from_millis(50);

/// A server that has its port, and is ready to serve.
pub struct Server {
    listener: TcpListener,
    port: u16,
    start: Start,
    opened: Option<Opened>,
    stop: Stop,
}

/// Stops a server from any thread.
#[derive(Clone, Default)]
pub struct Stop(Arc<Notify>);

impl Stop {
    /// Stops it: the connections are closed, and work in progress is dropped.
    pub fn now(&self) {
        self.0.notify_one();
    }
}

impl Server {
    /// Binds to a port of the loopback address, any free one for 0, to serve the page whose first
    /// case is this one.
    ///
    /// # Errors
    /// If the port is taken or not permitted.
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

    /// The same with the page of a structure as its first page.
    #[must_use]
    pub fn opening(self, structure: Opened) -> Self {
        let opened = Some(structure);
        Self { opened, ..self }
    }

    /// The address of the page.
    pub fn address(&self) -> String {
        format!("http://127.0.0.1:{}/", self.port)
    }

    /// A handle that stops it.
    pub fn stop(&self) -> Stop {
        self.stop.clone()
    }

    /// Serves until it is stopped.
    ///
    /// # Errors
    /// If the system gives no threads or closes the socket.
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
    // Each line of a map is sent without delay.
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
    // An error ends this connection only.
    let _ = served.await;
}
