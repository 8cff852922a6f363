#include <plisse/scene/scene.h>

namespace plisse {

InputError Scene::error_at(const std::string& pointer, const std::string& what_is_wrong,
                           const std::string& what_would_be_right) const {
    if (document)
        return document->error_at(pointer, what_is_wrong, what_would_be_right);
    return {pointer.empty() ? "scene" : "scene" + pointer, what_is_wrong, what_would_be_right};
}

InputError Scene::error_at(const std::string& pointer, const InputError& without_place) const {
    const std::string sentence = std::string(without_place.what()).substr(without_place.place().size() + 2);
    const std::size_t end = sentence.find("; ");
    return error_at(pointer, sentence.substr(0, end), sentence.substr(end + 2));
}

} // namespace plisse
