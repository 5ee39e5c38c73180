#include "dialog.h"
#include "filters.h"
#include "layers.h"

Results check(const RichParameterList& values, MeshDocument& document, vcg::CallBackPos* progress,
              const Say& say) {
    MeshModel& layer = current_layer(document);
    const Given given = read_layer(layer);
    auto input = wovenfit::new_input();
    set_parameters(*input, wovenfit::check_parameters(), values);
    input->set_mesh({given.points.data(), given.points.size()},
                    {given.triangles.data(), given.triangles.size()});
    if (progress != nullptr) {
        progress(1, "WovenFit: check");
    }
    const auto found = wovenfit::check_surface(*input);
    const auto defects = found->defects();
    if (!is_in(document, &layer)) {
        throw Refusal("the layer was closed while it was checked: run the filter on another");
    }
    select_only(layer, given, defects);
    const Results results = {
        {"defects", static_cast<int>(defects.size())},
        {"warnings", static_cast<int>(found->warning_count())},
        {"selected_vertices", layer.cm.svn},
        {"selected_faces", layer.cm.sfn},
    };
    tell_results(results, say);
    for (const QString& line : qt(found->text()).trimmed().split('\n')) {
        say(line);
    }
    if (!defects.empty()) {
        say(QString("%1 vertices and %2 faces are selected: what the defects are about.")
                .arg(layer.cm.svn)
                .arg(layer.cm.sfn));
    }
    return results;
}
