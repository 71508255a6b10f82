//! Conforming triangles out of a refinement: the split patterns of the paper's Figure 5.
