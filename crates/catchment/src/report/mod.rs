//! What a person or another program receives: JSON, text table, figures, Zarr.
