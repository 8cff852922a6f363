#include <plisse/subdivide/catmull_clark_step.h>

#include <algorithm>
#include <memory>

#include <opensubdiv/far/stencilTableFactory.h>
#include <opensubdiv/far/topologyDescriptor.h>
#include <opensubdiv/far/topologyRefinerFactory.h>

namespace plisse {

namespace {

namespace far = OpenSubdiv::Far;
namespace sdc = OpenSubdiv::Sdc;

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

std::unique_ptr<far::TopologyRefiner> refine_once(const ControlMesh& mesh) {
    const std::vector<int> corner_counts(mesh.faces.size(), 4);
    far::TopologyDescriptor descriptor;
    descriptor.numVertices = mesh.vertex_count;
    descriptor.numFaces = static_cast<int>(mesh.faces.size());
    descriptor.numVertsPerFace = corner_counts.data();
    descriptor.vertIndicesPerFace = mesh.faces.front().data();
    sdc::Options options;
    options.SetVtxBoundaryInterpolation(sdc::Options::VTX_BOUNDARY_NONE);
    using Factory = far::TopologyRefinerFactory<far::TopologyDescriptor>;
    std::unique_ptr<far::TopologyRefiner> refiner(
        Factory::Create(descriptor, Factory::Options(sdc::SCHEME_CATMARK, options)));
    refiner->RefineUniform(far::TopologyRefiner::UniformOptions(1));
    return refiner;
}

class Subdivider {
public:
    explicit Subdivider(const ControlMesh& coarse)
        : coarse_(coarse), connectivity_(coarse.connectivity()), refiner_(refine_once(coarse)) {}

    CatmullClarkStep run() {
        number_vertices();
        add_faces();
        add_boundary();
        add_weights();
        return std::move(step_);
    }

private:
    int vertex_count() const { return coarse_.vertex_count; }
    int edge_count() const { return connectivity_.edge_count(); }
    int face_count() const { return static_cast<int>(coarse_.faces.size()); }

    // Children are numbered vertices first, then edges, then faces, until the trimmed ones are left out.
    int of_vertex(int v) const { return v; }
    int of_edge(int e) const { return vertex_count() + e; }
    int of_face(int f) const { return vertex_count() + edge_count() + f; }
    VertexOrigin origin(int child) const {
        if (child < vertex_count())
            return {VertexOrigin::Kind::vertex, child};
        if (child < of_face(0))
            return {VertexOrigin::Kind::edge, child - vertex_count()};
        return {VertexOrigin::Kind::face, child - of_face(0)};
    }

    Quad quarter(int f, int corner) const {
        const auto edge = [&](int k) { return of_edge(connectivity_.edge(4 * f + k % 4)); };
        Quad child{};
        child[at(corner)] = of_vertex(coarse_.faces[at(f)][at(corner)]);
        child[at((corner + 1) % 4)] = edge(corner);
        child[at((corner + 2) % 4)] = of_face(f);
        child[at((corner + 3) % 4)] = edge(corner + 3);
        return child;
    }

    void number_vertices() {
        std::vector<int> rank(at(of_face(face_count())), 2); // 0 domain, 1 ghost, 2 trimmed
        const auto lower = [&](const Quad& quad, int to) {
            for (int v : quad)
                rank[at(v)] = std::min(rank[at(v)], to);
        };
        for (int f = 0; f < coarse_.domain_face_count; ++f)
            for (int c = 0; c < 4; ++c)
                lower(quarter(f, c), 0);
        for (int f = coarse_.domain_face_count; f < face_count(); ++f)
            for (int c = 0; c < 4; ++c) {
                const Quad quad = quarter(f, c);
                if (std::any_of(quad.begin(), quad.end(), [&](int v) { return rank[at(v)] == 0; }))
                    lower(quad, 1);
            }
        number_.assign(rank.size(), -1);
        for (int wanted : {0, 1}) {
            for (std::size_t child = 0; child < rank.size(); ++child)
                if (rank[child] == wanted) {
                    number_[child] = static_cast<int>(step_.origin.size());
                    step_.origin.push_back(origin(static_cast<int>(child)));
                }
            if (wanted == 0)
                step_.fine.domain_vertex_count = static_cast<int>(step_.origin.size());
        }
        step_.fine.vertex_count = static_cast<int>(step_.origin.size());
        const auto first_edge = number_.begin() + of_edge(0), first_face = number_.begin() + of_face(0);
        step_.vertex_child.assign(number_.begin(), first_edge);
        step_.edge_child.assign(first_edge, first_face);
        step_.face_child.assign(first_face, number_.end());
    }

    void add_faces() {
        for (int f = 0; f < face_count(); ++f)
            for (int c = 0; c < 4; ++c) {
                Quad quad = quarter(f, c);
                bool touches_domain = false;
                for (int& v : quad) {
                    v = number_[at(v)];
                    touches_domain = touches_domain || (v >= 0 && v < step_.fine.domain_vertex_count);
                }
                if (touches_domain)
                    step_.fine.faces.push_back(quad);
            }
        step_.fine.domain_face_count = 4 * coarse_.domain_face_count;
    }

    void add_boundary() {
        for (const auto& [face, side] : coarse_.boundary) {
            step_.fine.boundary.push_back({4 * face + side, side});
            step_.fine.boundary.push_back({4 * face + (side + 1) % 4, side});
        }
    }

    int child_in_library(const VertexOrigin& from) const {
        const far::TopologyLevel& base = refiner_->GetLevel(0);
        if (from.kind == VertexOrigin::Kind::vertex)
            return base.GetVertexChildVertex(from.number);
        if (from.kind == VertexOrigin::Kind::face)
            return base.GetFaceChildVertex(from.number);
        const int side = connectivity_.edge_side(from.number);
        return base.GetEdgeChildVertex(base.FindEdge(connectivity_.from(side), connectivity_.to(side)));
    }

    void add_weights() {
        using Factory = far::StencilTableFactoryReal<double>;
        Factory::Options options;
        options.generateIntermediateLevels = false;
        options.maxLevel = 1;
        const std::unique_ptr<const far::StencilTableReal<double>> table(Factory::Create(*refiner_, options));
        std::vector<Eigen::Triplet<double>> entries;
        for (int row = 0; row < step_.fine.vertex_count; ++row) {
            const auto stencil = table->GetStencil(child_in_library(step_.origin[at(row)]));
            for (int i = 0; i < stencil.GetSize(); ++i)
                entries.emplace_back(row, stencil.GetVertexIndices()[i], stencil.GetWeights()[i]);
        }
        step_.weights.resize(step_.fine.vertex_count, vertex_count());
        step_.weights.setFromTriplets(entries.begin(), entries.end());
    }

    const ControlMesh& coarse_;
    QuadConnectivity connectivity_;
    std::unique_ptr<far::TopologyRefiner> refiner_;
    std::vector<int> number_; ///< per child: its fine vertex, -1 where trimmed
    CatmullClarkStep step_;
};

} // namespace

CatmullClarkStep catmull_clark_step(const ControlMesh& coarse) {
    return Subdivider(coarse).run();
}

} // namespace plisse
