//! Listening, and who is answered.

use crate::browse::answer::Answer;
use crate::browse::insight::Insight;
use crate::browse::store::Store;
use crate::browse::{BrowseError, experience, family, kept, outing, pictures, player, run, site, start};
use axum::Router;
use axum::extract::rejection::PathRejection;
use axum::extract::{Path as AxumPath, Request, State};
use axum::http::{HeaderMap, HeaderName, HeaderValue, Method, StatusCode, header};
use axum::middleware::{Next, from_fn_with_state};
use axum::response::{IntoResponse, Response};
use axum::routing::{MethodRouter, get};
use serde::de::DeserializeOwned;
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
        // A page that is still being made is nobody's any more.
        runtime.shutdown_background();
        served.map_err(BrowseError::Serve)
    }
}

async fn interrupted() {
    if tokio::signal::ctrl_c().await.is_err() {
        std::future::pending::<()>().await;
    }
}

fn routes(store: Arc<Store>) -> Router {
    Router::new()
        .route("/", plain(start::page))
        .route("/runs", plain(run::all))
        .route("/style.css", plain(start::style))
        .route("/player.js", plain(|_| Ok(Answer::script(include_str!("player.js")))))
        .route("/family.js", plain(|_| Ok(Answer::script(include_str!("family.js")))))
        .route("/icon.svg", plain(|_| Ok(Answer::icon(include_str!("templates/icon.svg")))))
        .route("/site/{site}", page(site::page))
        .route("/site/{site}/{slot}/{number}", page(site::slot))
        .route("/outing/{id}", page(outing::page))
        .route("/outing/{id}/thumb.jpg", part(pictures::thumb))
        .route("/outing/{id}/track", part(player::track))
        .route("/outing/{id}/answers/{cell}", part(player::answers))
        .route("/outing/{id}/frame/{frame}/{side}", part(pictures::frame))
        .route("/outing/{id}/frame/{frame}/keypoints", part(player::keypoints))
        .route("/outing/{id}/frame/{frame}/matches/{experience}/{node}", part(player::matches))
        .route("/outing/{id}/frame/{frame}/before", part(player::before))
        .route("/experience/{id}", page(experience::page))
        .route("/experience/{id}/node/{node}", part(pictures::node))
        .route("/experience/{id}/family", part(family::family))
        .route("/run/{id}", page(run::page))
        .route("/run/{id}/report", page(run::report))
        .route("/reports/{name}", page(kept::page))
        .fallback(get(|State(store): State<Arc<Store>>| async move {
            work(store, |store| {
                let missing = BrowseError::NotHere("There is no page at this address.".to_owned());
                Ok(store.failure(&missing))
            })
            .await
        }))
        .with_state(store)
}

type Shown = Result<Answer, BrowseError>;

/// A page whose address holds no name.
fn plain(view: fn(&Store) -> Shown) -> MethodRouter<Arc<Store>> {
    get(move |State(store): State<Arc<Store>>| {
        work(store, move |store| Ok(view(store).unwrap_or_else(|error| store.failure(&error))))
    })
}

/// A page about what its address names; what fails is told on a page, too.
fn page<N: DeserializeOwned + Send + 'static>(view: fn(&Store, N) -> Shown) -> MethodRouter<Arc<Store>> {
    get(move |State(store): State<Arc<Store>>, name: Result<AxumPath<N>, PathRejection>| {
        work(store, move |store| {
            let shown = named(name).and_then(|name| view(store, name));
            Ok(shown.unwrap_or_else(|error| store.failure(&error)))
        })
    })
}

/// A part of a page: a picture, or what a script asks for; what fails is told in plain text.
fn part<N: DeserializeOwned + Send + 'static>(view: fn(&Store, N) -> Shown) -> MethodRouter<Arc<Store>> {
    get(move |State(store): State<Arc<Store>>, name: Result<AxumPath<N>, PathRejection>| {
        work(store, move |store| named(name).and_then(|name| view(store, name)))
    })
}

fn named<N>(name: Result<AxumPath<N>, PathRejection>) -> Result<N, BrowseError> {
    let strange = |_| BrowseError::NotHere("There is nothing at this address.".to_owned());
    name.map(|AxumPath(name)| name).map_err(strange)
}

/// Reads and computes beside the socket's own thread, which goes on listening.
async fn work(store: Arc<Store>, view: impl FnOnce(&Store) -> Shown + Send + 'static) -> Response {
    let told = |status, error: &dyn std::fmt::Display| Answer::text(status, error.to_string());
    let shown = tokio::task::spawn_blocking(move || view(&store)).await;
    match shown {
        Ok(Ok(answer)) => answer,
        Ok(Err(error)) if error.is_not_here() => told(StatusCode::NOT_FOUND, &error),
        Ok(Err(error)) => told(StatusCode::INTERNAL_SERVER_ERROR, &error),
        Err(error) => told(StatusCode::INTERNAL_SERVER_ERROR, &error),
    }
    .into_response()
}

/// Only GET, and only for this address: a page elsewhere whose name was made to lead here has another name in `Host`.
async fn guard(State(port): State<u16>, request: Request, next: Next) -> Response {
    let refused = |status, text: &str| Answer::text(status, text).into_response();
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
    // The port of the scheme is left out of a name.
    let (name, found) = host.rsplit_once(':').unwrap_or((host, "80"));
    ["127.0.0.1", "localhost"].contains(&name) && found == port.to_string()
}
