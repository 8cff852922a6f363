#include <plisse/model/dead_loads.h>

#include <plisse/energy/loads.h>

namespace plisse {

DeadLoads::DeadLoads(const Discretization& discretization) : model_(discretization.model()) {
    const Positions& rest = discretization.hierarchy().finest().rest;
    const LevelLayout& layout = discretization.layout(discretization.finest());
    std::vector<double> density, thickness;
    for (int body : layout.body_face_part) {
        const Material& material = model_.bodies[static_cast<std::size_t>(body)].material;
        density.push_back(material.density);
        thickness.push_back(material.thickness);
    }
    masses_ = lumped_masses(rest, layout.body_faces, density, thickness);
    areas_ = vertex_areas(rest, layout.body_faces);
}

Positions DeadLoads::weight(double t) const {
    Positions forces = Positions::Zero(3, masses_.size());
    add_weight(masses_, model_.gravity.at(t), forces);
    return forces;
}

Positions DeadLoads::loads(double t) const {
    Positions forces = Positions::Zero(3, masses_.size());
    for (const Load& load : model_.loads)
        if (load.kind == Load::Kind::force)
            add_shared_force(areas_, load.vertices, load.value.at(t), forces);
        else
            add_traction(areas_, load.vertices, load.value.at(t), forces);
    return forces;
}

} // namespace plisse
