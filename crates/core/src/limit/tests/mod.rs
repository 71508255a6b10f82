//! Tests of the analysis against closed forms, against the paper's own construction and against brute force.

mod closed_forms;
