//! Many evaluations at once: reproduction of published tables.
