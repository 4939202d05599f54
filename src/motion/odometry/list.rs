//! A list in borrowed memory.

use core::ops::{Deref, DerefMut};

/// The first `len` of some places.
#[derive(Debug)]
pub(super) struct List<'a, T> {
    pub places: &'a mut [T],
    pub len: &'a mut usize,
}

impl<T> List<'_, T> {
    /// Takes everything out.
    pub fn clear(&mut self) {
        *self.len = 0;
    }

    /// Adds an item, if there is a place for it.
    pub fn push(&mut self, item: T) {
        if let Some(place) = self.places.get_mut(*self.len) {
            *place = item;
            *self.len += 1;
        }
    }
}

impl<T> Deref for List<'_, T> {
    type Target = [T];

    fn deref(&self) -> &[T] {
        self.places.get(..*self.len).unwrap_or_default()
    }
}

impl<T> DerefMut for List<'_, T> {
    fn deref_mut(&mut self) -> &mut [T] {
        self.places.get_mut(..*self.len).unwrap_or_default()
    }
}
