//! IR to CL: how an operation becomes moves: passes, linking, entry, clearance.
