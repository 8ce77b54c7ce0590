//! The Utah teapot.
