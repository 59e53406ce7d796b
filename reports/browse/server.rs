//! Listening, and who is answered.

use super::error::BrowseError;
use super::insight::Insight;
use super::reply::Reply;
use super::routes::routes;
use super::store::Store;
use axum::extract::{Request, State};
use axum::http::{HeaderMap, HeaderName, HeaderValue, Method, StatusCode, header};
use axum::middleware::{Next, from_fn_with_state};
use axum::response::{IntoResponse, Response};
use std::net::{Ipv4Addr, TcpListener};
use std::path::Path;
use std::sync::Arc;

/// A store's pages, at an address of this machine that no other can reach.
pub struct Browser {
    listener: TcpListener,
    port: u16,
    store: Arc<Store>,
}

impl Browser {
    /// Opens the store to read it and takes a port of 127.0.0.1; 0 is any that is free.
    ///
    /// # Errors
    /// [`BrowseError::Catalog`] where the store cannot be read, [`BrowseError::Listen`] where the port cannot be had.
    pub fn listen(root: &Path, insight: Box<dyn Insight>, port: u16) -> Result<Self, BrowseError> {
        let store = Arc::new(Store::open(root, insight)?);
        let refused = |source| BrowseError::Listen { port, source };
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port)).map_err(refused)?;
        listener.set_nonblocking(true).map_err(refused)?;
        let port = listener.local_addr().map_err(refused)?.port();
        Ok(Self { listener, port, store })
    }

    /// The port.
    pub fn port(&self) -> u16 {
        self.port
    }

    /// Where the first page is.
    pub fn url(&self) -> String {
        format!("http://127.0.0.1:{}/", self.port)
    }

    /// Answers until Ctrl-C.
    ///
    /// # Errors
    /// [`BrowseError::Serve`] where the system takes the socket away.
    pub fn serve(self) -> Result<(), BrowseError> {
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().map_err(BrowseError::Serve)?;
        let served = runtime.block_on(async {
            let listener = tokio::net::TcpListener::from_std(self.listener)?;
            let pages = routes(self.store).layer(from_fn_with_state(self.port, guard));
            axum::serve(listener, pages).with_graceful_shutdown(interrupted()).await
        });
        // Nobody waits any more for a page that is still being made.
        runtime.shutdown_background();
        served.map_err(BrowseError::Serve)
    }
}

async fn interrupted() {
    if tokio::signal::ctrl_c().await.is_err() {
        std::future::pending::<()>().await;
    }
}

/// Only GET, and only for this address: a foreign page whose name was rebound to this address has another name in
/// `Host`.
async fn guard(State(port): State<u16>, request: Request, next: Next) -> Response {
    let refused = |status, text: &str| Reply::text(status, text).into_response();
    let mut response = if !is_ours(request.headers(), port) {
        let expected = format!("This is furrow browse: ask for http://127.0.0.1:{port}/ by that name.\n");
        refused(StatusCode::MISDIRECTED_REQUEST, &expected)
    } else if request.method() != Method::GET {
        let mut response = refused(StatusCode::METHOD_NOT_ALLOWED, "Only GET: nothing can be changed here.\n");
        response.headers_mut().insert(header::ALLOW, HeaderValue::from_static("GET"));
        response
    } else {
        next.run(request).await
    };
    let same_origin = HeaderValue::from_static("same-origin");
    response.headers_mut().insert(HeaderName::from_static("cross-origin-resource-policy"), same_origin);
    response
}

fn is_ours(headers: &HeaderMap, port: u16) -> bool {
    let mut hosts = headers.get_all(header::HOST).iter();
    let (Some(host), None) = (hosts.next().and_then(|host| host.to_str().ok()), hosts.next()) else { return false };
    // A name without a port means the port of the scheme.
    let (name, found) = host.rsplit_once(':').unwrap_or((host, "80"));
    ["127.0.0.1", "localhost"].contains(&name) && found == port.to_string()
}
