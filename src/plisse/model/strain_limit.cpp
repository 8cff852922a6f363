#include <plisse/model/strain_limit.h>

#include <algorithm>

namespace plisse {

namespace {

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

constexpr double strength = 0.25;   // of the barrier's force, by that of a membrane of strain 1
constexpr double raised_room = 0.3; // by the width, between a stretch and the limit that was raised for it

} // namespace

StrainLimit::LimitedFaces StrainLimit::limited_faces(const Discretization& discretization, int level) {
    const LevelLayout& layout = discretization.layout(level);
    LimitedFaces limited;
    for (std::size_t f = 0; f < layout.body_faces.size(); ++f) {
        const int body = layout.body_face_part[f];
        const Material& material = discretization.model().bodies[at(body)].material;
        if (!material.strain_limit)
            continue;
        const double limit = *material.strain_limit;
        const double onset = (1 + limit) / 2;
        const double width = limit - onset;
        limited.faces.push_back(layout.body_faces[f]);
        limited.body.push_back(body);
        limited.limits.limit.push_back(limit);
        limited.limits.onset.push_back(onset);
        limited.limits.stiffness.push_back(strength * material.youngs_modulus * material.thickness * width);
    }
    return limited;
}

StrainLimit::StrainLimit(const Discretization& discretization, int level)
    : StrainLimit(discretization.mesh(level).rest, limited_faces(discretization, level)) {}

StrainLimit::StrainLimit(const Positions& rest, LimitedFaces limited)
    : limits_(limited.limits), face_body_(std::move(limited.body)),
      energy_(rest, std::move(limited.faces), std::move(limited.limits)),
      assembly_(energy_, static_cast<int>(rest.cols())) {}

StrainLimit::Excess StrainLimit::excess(const Positions& x, double least_room) const {
    Excess excess;
    for (int f = 0; f < energy_.element_count(); ++f) {
        const double limit = limits_.limit[at(f)];
        const double stretch = energy_.triangles().principal_stretches(f, x)[0];
        const double share = (stretch - limit) / (limit - limits_.onset[at(f)]);
        if (share < -least_room)
            continue;
        ++excess.faces;
        if (excess.body >= 0 && share <= excess.share)
            continue;
        const Face& face = energy_.triangles().face(f);
        excess.body = face_body_[at(f)];
        excess.place = (x.col(face[0]) + x.col(face[1]) + x.col(face[2])) / 3;
        excess.stretch = stretch;
        excess.limit = limit;
        excess.share = share;
    }
    return excess;
}

void StrainLimit::raise(const Positions& x, double least_room, double stiffening) {
    StrainLimits raised = limits_;
    for (int f = 0; f < energy_.element_count(); ++f) {
        const double width = limits_.limit[at(f)] - limits_.onset[at(f)];
        const double stretch = energy_.triangles().principal_stretches(f, x)[0];
        if (stretch >= limits_.limit[at(f)] - least_room * width)
            raised.limit[at(f)] = stretch + raised_room * width;
        raised.stiffness[at(f)] *= stiffening;
    }
    energy_.set_limits(std::move(raised));
}

} // namespace plisse
