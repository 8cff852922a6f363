#include <plisse/model/pulls.h>

namespace plisse {

Pulls::Pulls(const Discretization& discretization, int level) {
    const HierarchyLevel& mesh = discretization.mesh(level);
    const bool is_finest = level == discretization.finest();
    for (const Pull& pull : discretization.model().pulls)
        for (const Pull::Point& point : pull.points) {
            Spring spring{{point.vertex, point.vertex, point.vertex}, Vec3::UnitX(), pull.stiffness, &point.to, {}};
            if (!is_finest) {
                const Anchor& anchor = mesh.to_finest[static_cast<std::size_t>(point.vertex)];
                spring.vertices = mesh.faces[static_cast<std::size_t>(anchor.face)];
                spring.weights = anchor.weights;
            }
            spring.to = point.to.at(0);
            springs_.push_back(spring);
        }
}

void Pulls::set_time(double t) {
    for (Spring& spring : springs_)
        spring.to = spring.place->at(t);
}

Vec3 Pulls::stretch(const Spring& spring, const Positions& x) {
    Vec3 point = Vec3::Zero();
    for (std::size_t k = 0; k < 3; ++k)
        point += spring.weights[static_cast<int>(k)] * x.col(spring.vertices[k]);
    return point - spring.to;
}

double Pulls::value(const Positions& x) const {
    double sum = 0;
    for (const Spring& spring : springs_)
        sum += 0.5 * spring.stiffness * stretch(spring, x).squaredNorm();
    return sum;
}

void Pulls::add_gradient(const Positions& x, Positions& gradient) const {
    for (const Spring& spring : springs_) {
        const Vec3 force = spring.stiffness * stretch(spring, x);
        for (std::size_t k = 0; k < 3; ++k)
            gradient.col(spring.vertices[k]) += spring.weights[static_cast<int>(k)] * force;
    }
}

void Pulls::add_hessian(NewtonSystem& system) const {
    for (const Spring& spring : springs_)
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t j = 0; j < 3; ++j) {
                const double weight = spring.weights[static_cast<int>(i)] * spring.weights[static_cast<int>(j)];
                if (weight != 0 && spring.vertices[i] >= spring.vertices[j])
                    system.add_block(spring.vertices[i], spring.vertices[j],
                                     spring.stiffness * weight * Mat3::Identity());
            }
}

} // namespace plisse
