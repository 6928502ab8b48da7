//! Traps of impacts, rests, releases and breaks, each a test with the name of the trap.

mod anywhere;
mod bookkeeping;
mod breaks;
mod budgets;
mod chatter;
mod figures;
mod misleading;
mod release;
mod scenes;
mod stops;
mod verdicts;
