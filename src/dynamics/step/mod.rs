//! Steps: how long one is, what it runs into, and how it is read, in free flight and in contact with a compliant stop.

mod choose;
pub(crate) mod chord;
pub(crate) mod contact;
mod exit;
pub(crate) mod path;
pub(crate) mod penetration;
mod rebound;
pub(crate) mod settings;
pub(crate) mod stepper;
pub(crate) mod work;
