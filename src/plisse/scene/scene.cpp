#include <plisse/scene/scene.h>

namespace plisse {

InputError Scene::error_at(const std::string& pointer, const std::string& what_is_wrong,
                           const std::string& what_would_be_right) const {
    if (document)
        return document->error_at(pointer, what_is_wrong, what_would_be_right);
    return {pointer.empty() ? "scene" : "scene" + pointer, what_is_wrong, what_would_be_right};
}

} // namespace plisse
