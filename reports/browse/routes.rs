//! Which address shows what.

use super::error::BrowseError;
use super::reply::Reply;
use super::store::Store;
use super::{answers, experience, kept, nearest, pictures, player, run, runs, site, start, traversal};
use axum::Router;
use axum::extract::rejection::PathRejection;
use axum::extract::{Path, State};
use axum::http::{StatusCode, Uri};
use axum::response::{IntoResponse, Redirect, Response};
use axum::routing::{MethodRouter, get};
use serde::de::DeserializeOwned;
use std::sync::Arc;

/// All pages and their parts.
pub(super) fn routes(store: Arc<Store>) -> Router {
    Router::new()
        .route("/", plain(start::page))
        .route("/runs", plain(runs::page))
        .route("/style.css", plain(start::style))
        .route("/player.js", plain(|_| Ok(Reply::script(include_str!("scripts/player.js")))))
        .route("/family.js", plain(|_| Ok(Reply::script(include_str!("scripts/family.js")))))
        .route("/icon.svg", plain(|_| Ok(Reply::icon(include_str!("templates/icon.svg")))))
        .route("/site/{site}", page(site::page))
        .route("/site/{site}/{slot}/{number}", page(site::slot))
        .route("/traversal/{id}", page(traversal::page))
        .route("/traversal/{id}/thumb.jpg", part(pictures::thumb))
        .route("/traversal/{id}/track", part(player::track))
        .route("/traversal/{id}/answers/{cell}", part(answers::answers))
        .route("/traversal/{id}/frame/{frame}/{side}", part(pictures::frame))
        .route("/traversal/{id}/frame/{frame}/keypoints", part(player::keypoints))
        .route("/traversal/{id}/frame/{frame}/matches/{experience}/{node}", part(player::matches))
        .route("/traversal/{id}/frame/{frame}/before", part(player::before))
        .route("/outing/{*rest}", get(moved))
        .route("/experience/{id}", page(experience::page))
        .route("/experience/{id}/node/{node}", part(pictures::node))
        .route("/experience/{id}/family", part(nearest::family))
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

/// Addresses of earlier versions, which people may have kept.
async fn moved(address: Uri) -> Redirect {
    Redirect::permanent(&address.path().replacen("/outing/", "/traversal/", 1))
}

type Shown = Result<Reply, BrowseError>;

/// A page whose address holds no name.
fn plain(view: fn(&Store) -> Shown) -> MethodRouter<Arc<Store>> {
    get(move |State(store): State<Arc<Store>>| {
        work(store, move |store| Ok(view(store).unwrap_or_else(|error| store.failure(&error))))
    })
}

/// A page about what its address names; errors are shown on a page, too.
fn page<N: DeserializeOwned + Send + 'static>(view: fn(&Store, N) -> Shown) -> MethodRouter<Arc<Store>> {
    get(move |State(store): State<Arc<Store>>, name: Result<Path<N>, PathRejection>| {
        work(store, move |store| {
            let shown = named(name).and_then(|name| view(store, name));
            Ok(shown.unwrap_or_else(|error| store.failure(&error)))
        })
    })
}

/// A part of a page: an image, or what a script asks for; errors are plain text.
fn part<N: DeserializeOwned + Send + 'static>(view: fn(&Store, N) -> Shown) -> MethodRouter<Arc<Store>> {
    get(move |State(store): State<Arc<Store>>, name: Result<Path<N>, PathRejection>| {
        work(store, move |store| named(name).and_then(|name| view(store, name)))
    })
}

fn named<N>(name: Result<Path<N>, PathRejection>) -> Result<N, BrowseError> {
    let bad_address = |_| BrowseError::NotHere("There is nothing at this address.".to_owned());
    name.map(|Path(name)| name).map_err(bad_address)
}

/// Reads and computes beside the socket's own thread, which goes on listening.
async fn work(store: Arc<Store>, view: impl FnOnce(&Store) -> Shown + Send + 'static) -> Response {
    let failed = |status, error: &dyn std::fmt::Display| Reply::text(status, error.to_string());
    let shown = tokio::task::spawn_blocking(move || view(&store)).await;
    match shown {
        Ok(Ok(answer)) => answer,
        Ok(Err(error)) if error.is_not_here() => failed(StatusCode::NOT_FOUND, &error),
        Ok(Err(error)) => failed(StatusCode::INTERNAL_SERVER_ERROR, &error),
        Err(error) => failed(StatusCode::INTERNAL_SERVER_ERROR, &error),
    }
    .into_response()
}
