//! Steps in free flight and in contact with a compliant stop: length, first event, and evaluation.

mod choose;
pub(crate) mod choose_quasi_static;
pub(crate) mod chord;
pub(crate) mod contact;
mod contact_path;
mod exit;
pub(crate) mod impact;
mod impact_path;
pub(crate) mod path;
pub(crate) mod penetration;
pub(crate) mod quasi_static;
mod rebound;
pub(crate) mod stepper;
pub(crate) mod work;
