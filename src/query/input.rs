//! Inputs that are shared by reference: [`Shared`] and [`ByIdentity`].

use std::sync::Arc;

/// A shared input. Two are equal if they are the same allocation or if their contents are equal.
#[derive(Debug)]
pub struct Shared<T>(pub Arc<T>);

impl<T> Clone for Shared<T> {
    fn clone(&self) -> Self {
        Self(self.0.clone())
    }
}

impl<T: PartialEq> PartialEq for Shared<T> {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0) || self.0 == other.0
    }
}

/// A shared input. Two are equal only if they are the same allocation; contents are not compared.
#[derive(Debug)]
pub struct ByIdentity<T: ?Sized>(pub Arc<T>);

impl<T: ?Sized> Clone for ByIdentity<T> {
    fn clone(&self) -> Self {
        Self(self.0.clone())
    }
}

impl<T: ?Sized> PartialEq for ByIdentity<T> {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}
