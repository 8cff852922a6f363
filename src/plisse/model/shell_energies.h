#pragma once

#include <memory>
#include <vector>

#include <plisse/energy/assembly.h>
#include <plisse/energy/hinge.h>
#include <plisse/energy/koiter.h>
#include <plisse/energy/membrane.h>
#include <plisse/energy/pressure.h>
#include <plisse/model/discretization.h>
#include <plisse/model/model.h>

namespace plisse {

/// The elastic energies of all bodies on one mesh, and the pressure of its closed bodies.
class ShellEnergies {
public:
    struct Parts {
        bool membrane = true;
        bool bending = true;
        bool pressure = true;
    };

    /// Of the body faces of one level, whose rest positions and layout these are.
    ShellEnergies(const Model& model, const Positions& rest, const LevelLayout& layout, Parts parts);

    /// Pressures at time t.
    void set_time(double t);

    double elastic_value(const Positions& y) const;
    void add_elastic_gradient(const Positions& y, Positions& gradient) const;
    double pressure_value(const Positions& y) const;
    void add_pressure_gradient(const Positions& y, Positions& gradient) const;
    /// Finds where the elastic terms' blocks go in the system, which was made with pairs().
    void place_in(const NewtonSystem& system);
    /// Adds the Hessian of the elastic terms to the system of place_in, projected element by element when `project` is
    /// set.
    void add_hessian(const Positions& y, NewtonSystem& system, bool project) const;
    std::vector<Edge> pairs() const;

    /// Forces of pressure on open bodies with the normals of y, frozen (N per vertex).
    Positions open_pressure_forces(const Positions& y, double t) const;

private:
    struct Term {
        std::unique_ptr<ElementEnergy> energy; ///< what the sum refers to, if anything
        std::unique_ptr<AssembledEnergy> sum;
    };
    struct ClosedBody {
        int body;
        std::unique_ptr<PressureEnergy> energy;
        std::unique_ptr<ElementAssembly> assembly;
    };
    struct OpenBody {
        int body;
        std::vector<Face> faces;
    };
    void add_term(std::unique_ptr<ElementEnergy> energy);

    const Model& model_;
    int vertex_count_;
    std::vector<Term> elastic_;
    std::vector<ClosedBody> closed_;
    std::vector<OpenBody> open_;
};

} // namespace plisse
