// Limit stencils of Loop's surface with OpenSubdiv's Far::LimitStencilTable, one thread: positions, both derivatives and unit
// normals at given places, again and again for moving control points.
// Usage: opensubdiv_stencils float|double FILE.obj PLACES, the latter with lines "face s t". Prints "stencils bytes" once they are made,
// the bytes of sizes, offsets, indices and weights; then answers each line of standard input: "p" evaluates positions, "n"
// positions and normals, for the next of 16 frames, and prints the seconds of CPU time; "w FILE" writes the positions of the control mesh
// as it is. A frame turns the control points around the third axis by up to 0.3 radians, the more the higher they are.
#include <opensubdiv/far/primvarRefiner.h>
#include <opensubdiv/far/stencilTableFactory.h>
#include <opensubdiv/far/topologyDescriptor.h>

#include <cmath>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <fstream>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

using namespace OpenSubdiv;

template <class REAL> struct Point {
    REAL p[3];
    void Clear(void * = nullptr) { p[0] = p[1] = p[2] = REAL(0); }
    void AddWithWeight(Point const &other, REAL weight) {
        for (int i = 0; i < 3; ++i) p[i] += weight * other.p[i];
    }
};

static double cpu_seconds() {
    timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return t.tv_sec + 1e-9 * t.tv_nsec;
}

static int const FRAMES = 16;

template <class REAL> static int run(char const *model, char const *where) {
    std::vector<double> read;
    std::vector<int> indices, sizes;
    std::ifstream file(model);
    for (std::string line; std::getline(file, line);) {
        std::istringstream words(line);
        std::string kind, word;
        words >> kind;
        if (kind == "v") {
            double x;
            for (int i = 0; i < 3 && words >> x; ++i) read.push_back(x);
        } else if (kind == "f") {
            int size = 0;
            for (; words >> word; ++size) indices.push_back(std::atoi(word.c_str()) - 1);
            sizes.push_back(size);
        }
    }
    size_t const count = read.size() / 3;
    double low = read[2], high = read[2];
    for (size_t i = 0; i < count; ++i) {
        low = std::min(low, read[3 * i + 2]);
        high = std::max(high, read[3 * i + 2]);
    }
    std::vector<std::vector<Point<REAL>>> frames(FRAMES + 1, std::vector<Point<REAL>>(count));
    for (int frame = 0; frame <= FRAMES; ++frame) {
        for (size_t i = 0; i < count; ++i) {
            double const *p = &read[3 * i];
            double const angle = 0.3 * frame / FRAMES * (p[2] - low) / (high - low);
            frames[frame][i] = {{REAL(p[0] * std::cos(angle) - p[1] * std::sin(angle)),
                                 REAL(p[0] * std::sin(angle) + p[1] * std::cos(angle)), REAL(p[2])}};
        }
    }

    Far::TopologyDescriptor descriptor;
    descriptor.numVertices = static_cast<int>(count);
    descriptor.numFaces = static_cast<int>(sizes.size());
    descriptor.numVertsPerFace = sizes.data();
    descriptor.vertIndicesPerFace = indices.data();
    Sdc::Options options;
    options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    typedef Far::TopologyRefinerFactory<Far::TopologyDescriptor> Factory;
    Far::TopologyRefiner *refiner = Factory::Create(descriptor, Factory::Options(Sdc::SCHEME_LOOP, options));
    Far::TopologyRefiner::AdaptiveOptions adaptive(5);
    adaptive.useInfSharpPatch = true;
    refiner->RefineAdaptive(adaptive);

    // Places stand face by face; each run of one face is an array of locations.
    std::vector<int> faces;
    std::vector<REAL> s, t;
    std::ifstream places(where);
    int face;
    for (double a, b; places >> face >> a >> b;) {
        faces.push_back(face);
        s.push_back(REAL(a));
        t.push_back(REAL(b));
    }
    typedef Far::LimitStencilTableFactoryReal<REAL> Stencils;
    typename Stencils::LocationArrayVec locations;
    for (size_t i = 0, j; i < faces.size(); i = j) {
        for (j = i; j < faces.size() && faces[j] == faces[i];) ++j;
        typename Stencils::LocationArray array;
        array.ptexIdx = faces[i];
        array.numLocations = static_cast<int>(j - i);
        array.s = &s[i];
        array.t = &t[i];
        locations.push_back(array);
    }
    typename Stencils::Options stencils;
    stencils.generate1stDerivatives = true;
    Far::LimitStencilTableReal<REAL> const *table = Stencils::Create(*refiner, locations, nullptr, nullptr, stencils);
    size_t const made = table->GetNumStencils();
    if (made != faces.size()) return 3;
    size_t const weights = table->GetControlIndices().size();
    std::printf("%zu %zu\n", made, made * 2 * sizeof(int) + weights * (sizeof(int) + 3 * sizeof(REAL)));
    std::fflush(stdout);

    std::vector<Point<REAL>> points(made), by_s(made), by_t(made), normals(made);
    int next = 0;
    for (std::string line; std::getline(std::cin, line);) {
        if (line[0] == 'w') {
            table->UpdateValues(frames[0].data(), points.data());
            std::ofstream out(line.substr(2), std::ios::binary);
            for (auto const &point : points) {
                double const p[3] = {double(point.p[0]), double(point.p[1]), double(point.p[2])};
                out.write(reinterpret_cast<char const *>(p), sizeof p);
            }
            out.close();
            std::printf("0\n");
        } else {
            std::vector<Point<REAL>> const &control = frames[1 + next++ % FRAMES];
            double const start = cpu_seconds();
            table->UpdateValues(control.data(), points.data());
            if (line[0] == 'n') {
                table->UpdateDerivs(control.data(), by_s.data(), by_t.data());
                for (size_t i = 0; i < made; ++i) {
                    REAL const *a = by_s[i].p, *b = by_t[i].p;
                    REAL const n[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
                    REAL const square = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
                    REAL const factor = square > 0 ? REAL(1) / std::sqrt(square) : REAL(0);
                    for (int axis = 0; axis < 3; ++axis) normals[i].p[axis] = n[axis] * factor;
                }
            }
            std::printf("%.9f\n", cpu_seconds() - start);
        }
        std::fflush(stdout);
    }
    return 0;
}

int main(int argc, char **argv) {
    if (argc != 4) return 2;
    return std::strcmp(argv[1], "float") == 0 ? run<float>(argv[2], argv[3]) : run<double>(argv[2], argv[3]);
}
