//! What was made lately, kept in memory.

use hashlink::LruCache;
use std::hash::Hash;
use std::sync::{Arc, Mutex, PoisonError};

/// What was made last, the latest used last.
pub(super) struct Cache<K, V>(Mutex<LruCache<K, Arc<V>>>);

impl<K: Hash + Eq, V> Cache<K, V> {
    /// An empty one for so many values.
    pub fn new(most: usize) -> Self {
        Self(Mutex::new(LruCache::new(most)))
    }

    /// What is kept under a key, or what `make` makes. Two who ask at once may both make it.
    pub fn get_or_make<E>(&self, key: K, make: impl FnOnce() -> Result<V, E>) -> Result<Arc<V>, E> {
        // A panic elsewhere leaves the cache itself sound.
        let cache = || self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(kept) = cache().get(&key) {
            return Ok(kept.clone());
        }
        let made = Arc::new(make()?);
        cache().insert(key, made.clone());
        Ok(made)
    }
}
