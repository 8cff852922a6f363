#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "page_assets.h"

namespace plisse::studio {

/// A scene that comes with the program.
struct GalleryScene {
    std::string id, title, words;           ///< what it is called, and what it shows in a sentence
    int vertices = 0, levels = 0;           ///< of the finest mesh; of meshes
    std::string_view text;                  ///< its scene file
    std::span<const unsigned char> picture; ///< PNG
};

/// The scenes of the gallery, in order.
const std::vector<GalleryScene>& gallery();
/// Null when there is none of this id.
const GalleryScene* find_gallery_scene(std::string_view id);
/// As the page asks for it.
std::string gallery_json();

} // namespace plisse::studio
