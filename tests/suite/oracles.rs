//! Problems with exact answers, each asserted to the digits that its conditioning allows.

mod ball;
mod consistent;
mod forced;
mod free;
mod late;
mod ledger;
mod linear;
#[cfg(any())] // does not hold yet
mod pending;
mod symmetry;
