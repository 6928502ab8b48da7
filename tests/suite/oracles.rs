//! Problems with exact answers, each asserted to the digits that its conditioning allows.

mod ball;
mod consistent;
mod demanding;
mod exact;
mod forced;
mod free;
mod late;
mod ledger;
mod linear;
mod symmetry;
