#include <plisse/drive/patch_relaxation.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <plisse/contact/contact.h>
#include <plisse/energy/assembly.h>
#include <plisse/energy/membrane.h>
#include <plisse/solve/newton.h>

namespace plisse {

namespace {

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

/// The faces in reach of a patch in numbers of their own.
struct LocalMesh {
    double room = 0;      ///< m: how far a free vertex may go along each axis; all faces in reach of it there are known
    std::vector<int> ids; ///< hierarchy id of each local vertex, ascending
    std::vector<Face> faces;
    std::vector<Face> elastic_faces; ///< those with a free corner
    Positions x, rest;
    std::vector<int> part; ///< 0 body, 1 obstacle
    std::vector<std::uint8_t> prescribed;

    int local(int id) const { return static_cast<int>(std::lower_bound(ids.begin(), ids.end(), id) - ids.begin()); }
};

/// The faces that those of the free vertices may come within reach of, ascending.
std::vector<int> faces_near(const ExpandingMesh& mesh, std::span<const int> free, double beyond) {
    std::vector<int> near, of_one;
    for (int v : free)
        for (int f : mesh.faces().vertex_faces(v)) {
            Box box;
            for (int w : mesh.faces().face(f))
                box.include(mesh.position(w));
            mesh.grid().query(box.inflated(beyond), of_one);
            near.insert(near.end(), of_one.begin(), of_one.end());
        }
    std::sort(near.begin(), near.end());
    near.erase(std::unique(near.begin(), near.end()), near.end());
    return near;
}

LocalMesh local_mesh(const ExpandingMesh& mesh, std::span<const int> free, double reach) {
    LocalMesh local;
    local.room = 2 * reach;
    const std::vector<int> near = faces_near(mesh, free, local.room + reach);
    for (int f : near)
        for (int v : mesh.faces().face(f))
            local.ids.push_back(v);
    std::sort(local.ids.begin(), local.ids.end());
    local.ids.erase(std::unique(local.ids.begin(), local.ids.end()), local.ids.end());
    const int count = static_cast<int>(local.ids.size());
    local.x.resize(3, count);
    local.rest.resize(3, count);
    local.part.resize(at(count));
    local.prescribed.assign(3 * at(count), 1);
    for (int v = 0; v < count; ++v) {
        local.x.col(v) = mesh.position(local.ids[at(v)]);
        local.rest.col(v) = mesh.rest().col(local.ids[at(v)]);
        local.part[at(v)] = mesh.is_obstacle_vertex(local.ids[at(v)]);
    }
    for (int v : free)
        std::fill_n(local.prescribed.begin() + 3 * local.local(v), 3, std::uint8_t{0});
    for (int f : near) {
        Face face;
        bool elastic = false;
        for (std::size_t k = 0; k < 3; ++k) {
            face[k] = local.local(mesh.faces().face(f)[k]);
            elastic = elastic || !local.prescribed[3 * at(face[k])];
        }
        local.faces.push_back(face);
        if (elastic)
            local.elastic_faces.push_back(face);
    }
    return local;
}

class PatchProblem : public Objective {
public:
    PatchProblem(const LocalMesh& local, const Material& material, double distance)
        : membrane_(local.rest, local.elastic_faces, materials(local, material)),
          assembly_(membrane_, static_cast<int>(local.ids.size())), room_(local.room), targets_(as_vector(local.x)),
          anchor_(targets_) {
        ContactOptions options;
        options.distance = distance;
        options.stiffness = material.youngs_modulus;
        collision_ = CollisionMesh(local.rest, local.faces, local.part, {0, 1});
        set_stiffness(options);
        system_ = NewtonSystem(local.prescribed, assembly_.pairs());
        assembly_.place_in(system_);
        inertia_ = 1e-3 * material.youngs_modulus * material.thickness;
    }

    void set_stiffness(const ContactOptions& options) {
        options_ = options;
        contact_ = std::make_unique<Contact>(collision_, options_);
    }
    void stiffen() {
        options_.stiffness *= 10;
        set_stiffness(options_);
    }
    double gap(const VecX& x) { return contact_->min_gap(as_positions(x)); }

    double value(const VecX& x) override {
        const Positions points = as_positions(x);
        const double elastic = assembly_.value(points);
        return elastic + contact_->value(points) + 0.5 * inertia_ * (x - anchor_).squaredNorm();
    }
    void gradient(const VecX& x, VecX& gradient) override {
        const Positions points = as_positions(x);
        Positions sum = as_positions(VecX(inertia_ * (x - anchor_)));
        assembly_.add_gradient(points, sum);
        contact_->add_gradient(points, sum);
        gradient = as_vector(sum);
    }
    void assemble(const VecX& x, NewtonSystem& system, bool project) override {
        const Positions points = as_positions(x);
        system.begin(contact_->coupled_pairs(points));
        for (int v = 0; v < points.cols(); ++v)
            system.add_block(v, v, inertia_ * Mat3::Identity());
        assembly_.add_hessian(points, system, project);
        contact_->add_hessian(points, system, project);
    }
    NewtonSystem& system() override { return system_; }
    const VecX& targets() const override { return targets_; }
    /// Nothing is known of what lies outside the room, so no vertex may leave it.
    double max_step(const VecX& x, const VecX& d) override {
        double alpha = 1;
        for (Eigen::Index i = 0; i < d.size(); ++i)
            if (d[i] != 0)
                alpha = std::min(alpha, std::max(0.0, (anchor_[i] + std::copysign(room_, d[i]) - x[i]) / d[i]));
        return alpha * contact_->max_step(as_positions(x), as_positions(VecX(alpha * d)));
    }

private:
    static MembraneMaterials materials(const LocalMesh& local, const Material& material) {
        const Lame lame = plane_stress_lame(material.youngs_modulus, material.poisson_ratio);
        const std::size_t count = local.elastic_faces.size();
        return {std::vector<double>(count, lame.mu), std::vector<double>(count, lame.lambda),
                std::vector<double>(count, material.thickness)};
    }

    MembraneEnergy membrane_;
    ElementAssembly assembly_;
    CollisionMesh collision_;
    ContactOptions options_;
    std::unique_ptr<Contact> contact_;
    NewtonSystem system_;
    double room_;
    VecX targets_, anchor_;
    double inertia_ = 0;
};

} // namespace

std::vector<int> patch_vertices(const ExpandingMesh& mesh, const Collapse& collapse) {
    std::vector<int> vertices = collapse.ring;
    for (int v : {collapse.i, collapse.j, collapse.k})
        if (mesh.faces().has_vertex(v))
            vertices.push_back(v);
    std::sort(vertices.begin(), vertices.end());
    return vertices;
}

double relax_patch(ExpandingMesh& mesh, std::span<const int> free, double wanted_gap, Context& context) {
    constexpr int rounds = 5;
    const Model& model = mesh.discretization().model();
    const double distance = std::max(4 * wanted_gap, model.contact.thickness + model.contact.distance);
    const LocalMesh local = local_mesh(mesh, free, distance);
    PatchProblem problem(local, model.bodies.front().material, distance);
    LinearSolver solver;
    VecX x = as_vector(local.x);
    NewtonOptions options;
    options.tolerance = 1e-3 * wanted_gap;
    options.max_iterations = 30;
    double gap = 0;
    for (int round = 0; round < rounds; ++round) {
        minimize(problem, solver, x, options, context);
        gap = problem.gap(x);
        if (gap >= wanted_gap)
            break;
        problem.stiffen();
    }
    std::vector<int> touched;
    for (int v : free) {
        mesh.set_position(v, as_positions(x).col(local.local(v)));
        touched.insert(touched.end(), mesh.faces().vertex_faces(v).begin(), mesh.faces().vertex_faces(v).end());
    }
    mesh.update_boxes(touched, [&](int v) { return Box{mesh.position(v), mesh.position(v)}; });
    return gap;
}

} // namespace plisse
