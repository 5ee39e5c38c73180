#include <QPointer>
#include <algorithm>
#include <utility>

#include "dialog.h"
#include "files.h"
#include "filters.h"
#include "layers.h"
#include "picked_points.h"

namespace {

// The host's bar moves, and its window stays alive, this often.
constexpr uint64_t BETWEEN_LOOKS_MS = 50;

void add_picked(wovenfit::Input& input, const RichParameterList& values, const Say& say) {
    const QString file = values.getOpenFileName(names::points_file);
    if (file.trimmed().isEmpty()) {
        return;
    }
    const auto points = read_picked_points(file, pressure_unit(values));
    for (const PickedPressure& point : points) {
        input.add_pressure(point.at, point.value, rs(point.unit));
    }
    say(QString("%1 pressures are taken from %2.").arg(points.size()).arg(file));
}

void add_quality(wovenfit::Input& input, const RichParameterList& values, const MeshModel& layer,
                 const Given& given) {
    if (!values.getBool(names::from_quality)) {
        return;
    }
    if (!layer.hasDataMask(MeshModel::MM_VERTQUALITY)) {
        throw Refusal(QString("the layer \"%1\" has no vertex quality: give its vertices one (Filters > "
                              "Quality Measure and Computations), or switch off \"Pressures from vertex "
                              "quality\"")
                          .arg(layer.label()));
    }
    input.paint({given.quality.data(), given.quality.size()},
                number(values, names::quality_scale).toDouble(), rs(pressure_unit(values)));
}

rust::Box<wovenfit::Input> wishes(const RichParameterList& values, const MeshModel& layer,
                                  const Given& given, const Say& say) {
    auto input = wovenfit::new_input();
    set_parameters(*input, wovenfit::parameters(), values);
    const QString design = values.getOpenFileName(names::design_file);
    if (!design.trimmed().isEmpty()) {
        const QByteArray text = read_file(design);
        try {
            const auto* bytes = reinterpret_cast<const uint8_t*>(text.constData());
            input->read_design({bytes, static_cast<size_t>(text.size())});
        } catch (const std::exception& refused) {
            throw Refusal(QString("%1: %2").arg(design, refused.what()));
        }
    }
    set_fabric(*input, values);
    set_formats(*input, values);
    input->set_mesh({given.points.data(), given.points.size()},
                    {given.triangles.data(), given.triangles.size()});
    add_picked(*input, values, say);
    add_quality(*input, values, layer, given);
    if (values.getBool(names::selected_only)) {
        input->select({given.selected.data(), given.selected.size()});
    }
    return input;
}

rust::Box<wovenfit::Pattern> run(rust::Box<wovenfit::Input> input, vcg::CallBackPos* progress) {
    auto job = wovenfit::start(std::move(input));
    do {
        const wovenfit::Progress now = job->progress();
        const QByteArray said = QString("WovenFit: %1").arg(qt(now.stage)).toUtf8();
        if (progress != nullptr && !progress(now.percent, said.constData())) {
            job->cancel();
        }
    } while (!job->wait(BETWEEN_LOOKS_MS));
    return job->result();
}

// What a filter that waits cannot rely on: the host's window is alive meanwhile.
class Unchanged {
public:
    Unchanged(MeshDocument& document, MeshModel& layer)
        : document(&document), layer(&layer), vertices(layer.cm.vert.data()), faces(layer.cm.face.data()),
          vertex_count(layer.cm.vert.size()), face_count(layer.cm.face.size()) {}

    void or_refuse() const {
        const bool same = document && is_in(*document, layer) && layer->cm.vert.data() == vertices &&
                          layer->cm.face.data() == faces && layer->cm.vert.size() == vertex_count &&
                          layer->cm.face.size() == face_count;
        if (!same) {
            throw Refusal("the layer was changed or closed while its pattern was computed: nothing is "
                          "done; run the filter again");
        }
    }

private:
    QPointer<MeshDocument> document;
    MeshModel* layer;
    const CVertexO* vertices;
    const CFaceO* faces;
    size_t vertex_count;
    size_t face_count;
};

Results results_of(const wovenfit::Figures& figures, size_t warnings, size_t uncovered) {
    Results results = {
        {"width_mm", figures.width_mm},
        {"height_mm", figures.height_mm},
        {"area_mm2", figures.area_mm2},
        {"energy_n_mm", figures.energy},
        {"curvature_radius_mm", figures.curvature_radius_mm},
        {"steps", static_cast<int>(figures.steps)},
        {"converged", figures.converged},
        {"flipped", static_cast<int>(figures.flipped)},
        {"overlaps", static_cast<int>(figures.overlaps)},
        {"seam_mismatch_mm", figures.seam_mismatch_mm},
        {"pressures", static_cast<int>(figures.asked_kpa.size())},
        {"missed", static_cast<int>(figures.missed)},
        {"warnings", static_cast<int>(warnings)},
        {"uncovered_faces", static_cast<int>(uncovered)},
    };
#ifndef WOVENFIT_MESHLAB_2020
    // 2020.09 gives a script nothing back; its log has the table.
    const auto vector = [](const rust::Vec<double>& values) {
        const auto size = static_cast<Eigen::Index>(values.size());
        return QVariant::fromValue(Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(values.data(), size)));
    };
    results["asked_kpa"] = vector(figures.asked_kpa);
    results["computed_kpa"] = vector(figures.got_kpa);
#endif
    return results;
}

// What matters most is said last: MeshLab's log shows its end.
void tell(const wovenfit::Pattern& pattern, const Say& say) {
    const rust::Vec<rust::String> warnings = pattern.warnings();
    for (const rust::String& warning : warnings) {
        say("warning: " + qt(warning));
    }
    for (const QString& line : qt(pattern.table()).trimmed().split('\n')) {
        say(line);
    }
    if (!warnings.empty()) {
        say(QString("%1 above: read before you cut.")
                .arg(warnings.size() == 1 ? "1 warning" : QString("%1 warnings").arg(warnings.size())));
    }
}

} // namespace

Results flatten(const RichParameterList& values, MeshDocument& document, vcg::CallBackPos* progress,
                const Say& say) {
    MeshModel& layer = current_layer(document);
    const QString folder = values.getString(names::folder).trimmed();
    if (!folder.isEmpty()) {
        refuse_bad_folder(folder);
    }
    const Given given = read_layer(layer);
    const Unchanged unchanged(document, layer);
    auto input = wishes(values, layer, given, say);
    const double mm_per_unit = input->mm_per_unit();
    say(QString("The layer \"%1\" is taken to be in %2.").arg(layer.label(), qt(input->unit())));

    const auto pattern = run(std::move(input), progress);
    const wovenfit::Field field = chosen_field(values);
    const rust::Vec<double> shown = pattern->field(field);
    const rust::Vec<double> corners = pattern->given_corners();
    const wovenfit::Figures figures = pattern->figures();
    const size_t warnings = pattern->warnings().size();
    unchanged.or_refuse();
    if (!folder.isEmpty()) {
        const auto files = pattern->files();
        write_files(folder, files);
        for (const wovenfit::NamedFile& file : files) {
            for (const rust::String& note : file.notes) {
                say("note: " + qt(note));
            }
        }
    }

    // Nothing below refuses.
    const size_t uncovered = set_texture(layer, given, corners);
    add_pattern(document, given, mm_per_unit, *pattern, shown);
    const Results results = results_of(figures, warnings, uncovered);
    tell_results(results, say);
    if (!folder.isEmpty()) {
        say(QString("The report and the pattern are in %1; read report.html first.").arg(folder));
    }
    if (uncovered > 0) {
        say(QString("%1 of %2 faces of the layer are not covered by the brace and have no texture "
                    "coordinates.")
                .arg(uncovered)
                .arg(given.face.size()));
    }
    const auto [least, most] = std::minmax_element(shown.begin(), shown.end());
    say(QString("The layer \"Pattern\" is %1 x %2 mm; its colours are the %3, from %4 (blue) to %5 (red).")
            .arg(figures.width_mm, 0, 'f', 1)
            .arg(figures.height_mm, 0, 'f', 1)
            .arg(field_name(field))
            .arg(*least, 0, 'g', 3)
            .arg(*most, 0, 'g', 3));
    tell(*pattern, say);
    if (figures.asked_kpa.empty()) {
        say("warning: no pressure is asked for, so the fabric lies unstretched: choose a design file or picked "
            "points by the \"...\" button (MeshLab 2020.09 does not see a name that is typed), or take the "
            "pressures from the vertex quality");
    }
    return results;
}
