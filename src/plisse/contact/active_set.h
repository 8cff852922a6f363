#pragma once

#include <vector>

#include <plisse/contact/candidates.h>
#include <plisse/contact/clearances.h>
#include <plisse/contact/contact.h>
#include <plisse/contact/nearby_places.h>
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

    /// How far apart a candidate has to stay, m. Edges of one part may come as near as the points at their ends may:
    /// where they cross, their barrier keeps more.
    double least_distance(StencilKind kind, int candidate, const Candidates& candidates) const;
    void set_options(const ContactOptions& options) { options_ = options; }

private:
    struct Chunk {
        std::vector<ActivePair> pairs;
        std::vector<NearTriangle> near;
        std::vector<NearPlace> places;
        double energy, least_gap, least_thickness_share;
    };
    /// A candidate that is nearer than its activation distance.
    struct NearPair {
        PairRange range;
        Separation separation;
    };

    bool same_part(const std::array<int, 4>& stencil) const {
        return mesh_.part[static_cast<std::size_t>(stencil[0])] == mesh_.part[static_cast<std::size_t>(stencil[3])];
    }
    void find_chunk(const Candidates& candidates, StencilKind kind, int begin, int end, const Positions& x,
                    Chunk& chunk) const;
    /// Which a pair's range goes by, m.
    double rest_distance(const Candidates& candidates, StencilKind kind, int candidate) const;
    /// The separation of a candidate, unless it is that of a repelling end of an edge.
    std::optional<Separation> separate_unless_seen(const Candidates& candidates, StencilKind kind, int candidate,
                                                   const Stencil& stencil) const;
    /// Looks at one candidate, for gaps too.
    std::optional<NearPair> look_at(const Candidates& candidates, StencilKind kind, int candidate, const Positions& x,
                                    Chunk& chunk) const;
    /// Adds what the point of chunk.near repels.
    void add_places(const Positions& x, Chunk& chunk) const;
    void add_edges(const std::array<int, 2>& edges, const std::array<int, 4>& vertices, const NearPair& pair,
                   const Positions& x, Chunk& chunk) const;
    /// Ends of two edges that repel as points: those that some face of the other edge does not have as a corner.
    std::uint8_t repelling_ends(const std::array<int, 2>& edges, const std::array<int, 4>& vertices) const;
    static void add(const ActivePair& pair, const Positions& x, Chunk& chunk);

    const CollisionMesh& mesh_;
    ContactOptions options_;
    Clearances clearances_;
    Candidates::Drift drift_;
    std::vector<Chunk> chunks_;
    std::vector<ActivePair> pairs_;
    double energy_ = 0, least_gap_ = 0, least_thickness_share_ = 1;
};

} // namespace plisse
