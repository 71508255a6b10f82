// Uniform refinement with OpenSubdiv's Far::PrimvarRefiner, one thread, positions of the refined mesh: Catmull-Clark where
// the first face is a quad, Loop where it is a triangle.
// Usage: opensubdiv_far FILE.obj LEVEL REPEATS; prints "triangles seconds" for each repeat (CPU time), a quad being two.
#include <opensubdiv/far/primvarRefiner.h>
#include <opensubdiv/far/topologyDescriptor.h>

#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

using namespace OpenSubdiv;

struct Position {
    double p[3];
    void Clear(void * = nullptr) { p[0] = p[1] = p[2] = 0.0; }
    void AddWithWeight(Position const &other, double weight) {
        for (int i = 0; i < 3; ++i) p[i] += weight * other.p[i];
    }
};

static double cpu_seconds() {
    timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return t.tv_sec + 1e-9 * t.tv_nsec;
}

int main(int argc, char **argv) {
    if (argc != 4) return 2;
    int const level = std::atoi(argv[2]);
    int const repeats = std::atoi(argv[3]);
    std::vector<Position> positions;
    std::vector<int> indices, sizes;
    std::ifstream file(argv[1]);
    for (std::string line; std::getline(file, line);) {
        std::istringstream words(line);
        std::string kind, word;
        words >> kind;
        if (kind == "v") {
            Position v;
            words >> v.p[0] >> v.p[1] >> v.p[2];
            positions.push_back(v);
        } else if (kind == "f") {
            int size = 0;
            for (; words >> word; ++size) indices.push_back(std::atoi(word.c_str()) - 1);
            sizes.push_back(size);
        }
    }
    bool const quads = sizes[0] == 4;
    Sdc::SchemeType const scheme = quads ? Sdc::SCHEME_CATMARK : Sdc::SCHEME_LOOP;
    for (int repeat = 0; repeat < repeats; ++repeat) {
        double const start = cpu_seconds();
        Far::TopologyDescriptor descriptor;
        descriptor.numVertices = static_cast<int>(positions.size());
        descriptor.numFaces = static_cast<int>(sizes.size());
        descriptor.numVertsPerFace = sizes.data();
        descriptor.vertIndicesPerFace = indices.data();
        Sdc::Options options;
        options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
        typedef Far::TopologyRefinerFactory<Far::TopologyDescriptor> Factory;
        Far::TopologyRefiner *refiner =
            Factory::Create(descriptor, Factory::Options(scheme, options));
        refiner->RefineUniform(Far::TopologyRefiner::UniformOptions(level));
        Far::PrimvarRefinerReal<double> primvars(*refiner);
        std::vector<Position> coarse = positions, fine;
        for (int l = 1; l <= level; ++l) {
            fine.resize(refiner->GetLevel(l).GetNumVertices());
            primvars.Interpolate(l, coarse, fine);
            coarse.swap(fine);
        }
        int const triangles = refiner->GetLevel(level).GetNumFaces() * (quads ? 2 : 1);
        delete refiner;
        std::printf("%d %.6f\n", triangles, cpu_seconds() - start);
    }
}
