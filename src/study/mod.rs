//! Questions: a study in, a table out.
