//! impacts
