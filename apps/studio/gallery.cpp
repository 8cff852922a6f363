#include "gallery.h"

#include <algorithm>

#include <nlohmann/json.hpp>

namespace plisse::studio {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view folder = "gallery/";

std::span<const unsigned char> bytes_of(const std::string& path) {
    for (const Asset& asset : page_assets())
        if (asset.path == path)
            return asset.bytes;
    return {};
}

/// A scene says of itself, under "x-gallery", where it stands and what it is called.
std::vector<GalleryScene> read_gallery() {
    std::vector<std::pair<int, GalleryScene>> scenes;
    for (const Asset& asset : page_assets()) {
        if (!asset.path.starts_with(folder) || !asset.path.ends_with(".json"))
            continue;
        const std::string_view text(reinterpret_cast<const char*>(asset.bytes.data()), asset.bytes.size());
        const Json about = Json::parse(text, nullptr, true, true).at("x-gallery");
        GalleryScene scene;
        scene.id = asset.path.substr(folder.size(), asset.path.size() - folder.size() - 5);
        scene.title = about.at("title");
        scene.words = about.at("words");
        scene.vertices = about.at("vertices");
        scene.levels = about.at("levels");
        scene.text = text;
        scene.picture = bytes_of(std::string(folder) + scene.id + ".png");
        scenes.emplace_back(about.at("place").get<int>(), std::move(scene));
    }
    std::sort(scenes.begin(), scenes.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<GalleryScene> sorted;
    for (auto& [place, scene] : scenes)
        sorted.push_back(std::move(scene));
    return sorted;
}

} // namespace

const std::vector<GalleryScene>& gallery() {
    static const std::vector<GalleryScene> scenes = read_gallery();
    return scenes;
}

const GalleryScene* find_gallery_scene(std::string_view id) {
    for (const GalleryScene& scene : gallery())
        if (scene.id == id)
            return &scene;
    return nullptr;
}

std::string gallery_json() {
    Json list = Json::array();
    for (const GalleryScene& scene : gallery())
        list.push_back({{"id", scene.id},
                        {"title", scene.title},
                        {"words", scene.words},
                        {"picture", "/api/gallery/" + scene.id + ".png"},
                        {"vertices", scene.vertices},
                        {"levels", scene.levels}});
    return list.dump();
}

} // namespace plisse::studio
