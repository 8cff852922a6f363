#include <plisse/decimate/hierarchy_store.h>

namespace plisse {

DecimationResult decimate_once(const DecimationInput& input, const DecimationOptions& options, Context& context,
                               HierarchyStore* store) {
    const std::string key = store ? fingerprint(input, options) : "";
    if (store)
        if (auto kept = store->load(key))
            return std::move(*kept);
    DecimationResult result;
    result.hierarchy = decimate(input, options, &context, &result.summary);
    if (store && !context.cancelled()) // a cancelled decimation is not what was asked for
        store->save(key, result);
    return result;
}

} // namespace plisse
