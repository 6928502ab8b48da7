//! The traps of impacts, rests, releases and breaks: each a test whose name says the trap.

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
