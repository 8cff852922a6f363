#pragma once

#include <vector>

#include <plisse/contact/candidates.h>
#include <plisse/contact/contact.h>
#include <plisse/contact/pair_energy.h>

namespace plisse {

/// The pairs that repel at one set of positions, with their energy.
class ActiveSet {
public:
    /// mesh must outlive the object.
    ActiveSet(const CollisionMesh& mesh, const ContactOptions& options);

    /// Candidates must contain x.
    void find(const Candidates& candidates, const Positions& x);

    const std::vector<ActivePair>& pairs() const { return pairs_; }
    double energy() const { return energy_; }                               ///< J
    double least_gap() const { return least_gap_; }                         ///< m; as Contact::min_gap
    double least_thickness_share() const { return least_thickness_share_; } ///< as Contact's

    /// The range of a candidate.
    PairRange range(StencilKind kind, int candidate, const Candidates& candidates) const;
    void set_options(const ContactOptions& options) { options_ = options; }

private:
    struct Chunk {
        std::vector<ActivePair> pairs;
        double energy = 0, least_gap = 0, least_thickness_share = 0;
    };

    bool same_part(const std::array<int, 4>& stencil) const {
        return mesh_.part[static_cast<std::size_t>(stencil[0])] == mesh_.part[static_cast<std::size_t>(stencil[3])];
    }
    void find_chunk(const Candidates& candidates, StencilKind kind, int begin, int end, const Positions& x,
                    Chunk& chunk) const;
    PairParameters parameters(StencilKind kind, const std::array<int, 2>& primitives, const PairRange& range) const;

    const CollisionMesh& mesh_;
    ContactOptions options_;
    std::vector<double> edge_length_squared_; ///< at rest
    Candidates::Drift drift_;
    std::vector<Chunk> chunks_;
    std::vector<ActivePair> pairs_;
    double energy_ = 0, least_gap_ = 0, least_thickness_share_ = 1;
};

} // namespace plisse
