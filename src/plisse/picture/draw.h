#pragma once

#include <span>

#include <plisse/base/types.h>
#include <plisse/picture/camera.h>
#include <plisse/picture/image.h>
#include <plisse/picture/scalars.h>

namespace plisse {

/// What a picture shows: one mesh of all bodies and obstacles. The referenced data must outlive it.
struct Subject {
    const Positions& positions; ///< m; faces with a corner that is not finite are not drawn
    std::span<const Face> faces;
    std::span<const int> face_body; ///< body of every face; empty: all belong to body 0
    int body_count = 1;             ///< faces of bodies from this number on belong to obstacles

    bool is_obstacle(std::size_t face) const { return !face_body.empty() && face_body[face] >= body_count; }
};

struct DrawOptions {
    int width = 960, height = 640;    ///< pixels, at least 1
    View view;                        ///< direction and zoom
    const Positions* frame = nullptr; ///< points the camera must see; the subject's own when null
    bool edges = false;               ///< draw the mesh's edges
    bool tell_bodies_apart = true;    ///< a colour for each body, rather than one for all
    const Scalars* scalars = nullptr; ///< colour the bodies by these, with a legend
};

/// The points a picture of the subject must show: its bodies' vertices, and those of obstacles brought near the bodies,
/// so that a wide floor does not make a small body smaller still.
Positions framing_points(const Subject& subject);

/// Draws the subject, smoothly shaded, with soft shadows and ambient occlusion, on a light background. The same input
/// gives the same picture, whatever the number of threads.
Image draw(const Subject& subject, const DrawOptions& options);

} // namespace plisse
