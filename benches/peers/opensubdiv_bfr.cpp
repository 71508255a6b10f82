// Uniform tessellation of a limit surface with OpenSubdiv's Bfr, one thread, in double precision: limit position and unit
// normal of every vertex, each evaluated once, and the triangles. The surface is Catmull-Clark's where the first face is a
// quad, with approximation level 4, at which Bfr's vertices are on the surface; Loop's where it is a triangle.
// Usage: opensubdiv_bfr FILE.obj LEVEL REPEATS; prints "triangles seconds" for each repeat (CPU time). The control mesh's
// topology is built before the clock starts.
#include <opensubdiv/bfr/refinerSurfaceFactory.h>
#include <opensubdiv/bfr/surface.h>
#include <opensubdiv/bfr/tessellation.h>
#include <opensubdiv/far/topologyDescriptor.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

using namespace OpenSubdiv;

static double cpu_seconds() {
    timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return t.tv_sec + 1e-9 * t.tv_nsec;
}

int main(int argc, char **argv) {
    if (argc != 4) return 2;
    int const rate = 1 << std::atoi(argv[2]);
    int const repeats = std::atoi(argv[3]);
    std::vector<double> mesh;
    std::vector<int> indices, sizes;
    std::ifstream file(argv[1]);
    for (std::string line; std::getline(file, line);) {
        std::istringstream words(line);
        std::string kind, word;
        words >> kind;
        if (kind == "v") {
            for (double x; words >> x;) mesh.push_back(x);
        } else if (kind == "f") {
            int size = 0;
            for (; words >> word; ++size) indices.push_back(std::atoi(word.c_str()) - 1);
            sizes.push_back(size);
        }
    }
    Far::TopologyDescriptor descriptor;
    descriptor.numVertices = static_cast<int>(mesh.size() / 3);
    descriptor.numFaces = static_cast<int>(sizes.size());
    descriptor.numVertsPerFace = sizes.data();
    descriptor.vertIndicesPerFace = indices.data();
    int const sides = sizes[0];
    bool const quads = sides == 4;
    Sdc::Options options;
    options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    typedef Far::TopologyRefinerFactory<Far::TopologyDescriptor> Factory;
    Far::TopologyRefiner *refiner =
        Factory::Create(descriptor, Factory::Options(quads ? Sdc::SCHEME_CATMARK : Sdc::SCHEME_LOOP, options));
    Far::TopologyLevel const &base = refiner->GetLevel(0);

    for (int repeat = 0; repeat < repeats; ++repeat) {
        double const start = cpu_seconds();
        int const faces = base.GetNumFaces(), edges = base.GetNumEdges(), corners = base.GetNumVertices();
        int const on_edge = rate - 1, inside = quads ? on_edge * on_edge : on_edge * (rate - 2) / 2;
        int const triangles_of_face = rate * rate * (quads ? 2 : 1);
        size_t const vertices = corners + size_t(edges) * on_edge + size_t(faces) * inside;
        std::vector<double> positions(3 * vertices), normals(3 * vertices);
        std::vector<int> triangles(3 * size_t(faces) * triangles_of_face);
        std::vector<char> known(corners, 0), known_edge(edges, 0);

        typedef Bfr::RefinerSurfaceFactory<> SurfaceFactory;
        SurfaceFactory::Options precise;
        if (quads) precise.SetApproxLevelSmooth(4).SetApproxLevelSharp(4);
        SurfaceFactory factory(*refiner, precise);
        Bfr::Surface<double> surface;
        std::vector<double> points, coords;
        std::vector<int> names, facets;
        for (int face = 0; face < faces; ++face) {
            if (!factory.InitVertexSurface(face, &surface)) return 1;
            points.resize(3 * surface.GetNumPatchPoints());
            surface.PreparePatchPoints(mesh.data(), 3, points.data(), 3);
            Bfr::Tessellation tessellation(surface.GetParameterization(), rate);
            int const count = tessellation.GetNumCoords();
            coords.resize(2 * count);
            tessellation.GetCoords(coords.data());
            // Coordinates run around the boundary from corner to corner, and then inside.
            names.clear();
            std::vector<char> fresh(count, 1);
            Far::ConstIndexArray of_face = base.GetFaceVertices(face), around = base.GetFaceEdges(face);
            for (int side = 0; side < sides; ++side) {
                int const corner = of_face[side], edge = around[side];
                fresh[names.size()] = !known[corner];
                known[corner] = 1;
                names.push_back(corner);
                bool const forward = base.GetEdgeVertices(edge)[0] == corner;
                for (int i = 0; i < on_edge; ++i) {
                    fresh[names.size()] = !known_edge[edge];
                    names.push_back(corners + edge * on_edge + (forward ? i : on_edge - 1 - i));
                }
                known_edge[edge] = 1;
            }
            for (int i = 0; i < inside; ++i) names.push_back(corners + edges * on_edge + face * inside + i);
            for (int i = 0; i < count; ++i) {
                if (!fresh[i]) continue;
                double du[3], dv[3];
                double *p = &positions[3 * size_t(names[i])], *n = &normals[3 * size_t(names[i])];
                surface.Evaluate(&coords[2 * i], points.data(), 3, p, du, dv);
                n[0] = du[1] * dv[2] - du[2] * dv[1];
                n[1] = du[2] * dv[0] - du[0] * dv[2];
                n[2] = du[0] * dv[1] - du[1] * dv[0];
                double const length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
                for (int axis = 0; axis < 3; ++axis) n[axis] /= length;
            }
            int const facet_count = tessellation.GetNumFacets();
            facets.resize(tessellation.GetFacetSize() * facet_count);
            tessellation.GetFacets(facets.data());
            int *out = &triangles[3 * size_t(face) * triangles_of_face];
            int const size = tessellation.GetFacetSize();
            for (int f = 0; f < facet_count; ++f)
                for (int c = 0; c < 3; ++c) *out++ = names[facets[f * size + c]];
        }
        double const seconds = cpu_seconds() - start;
        // Something of everything, so that nothing is left out.
        double sum = 0.0;
        for (double x : positions) sum += x;
        for (double x : normals) sum += x;
        std::fprintf(stderr, "%.12g %d\n", sum, triangles.back());
        std::printf("%zu %.6f\n", triangles.size() / 3, seconds);
    }
    delete refiner;
}
