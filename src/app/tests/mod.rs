//! The window, driven headlessly by the names of its controls.
