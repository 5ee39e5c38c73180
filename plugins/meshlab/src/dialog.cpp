#include "dialog.h"

#include <array>
#include <charconv>
#include <cmath>

namespace {

const std::array<wovenfit::Field, 3> FIELDS = {wovenfit::Field::WarpStrain, wovenfit::Field::WeftStrain,
                                               wovenfit::Field::Pressure};
const QStringList PRESSURE_UNITS = {"kPa", "mmHg"};
const QStringList PATTERN_UNITS = {"mm", "in"};

// "close_holes" as a label: "Close holes (mm)".
QString label(QString name, const QString& unit) {
    name.replace('_', ' ');
    name[0] = name[0].toUpper();
    return unit.isEmpty() ? name : QString("%1 (%2)").arg(name, unit);
}

QString tooltip(const wovenfit::Parameter& row) {
    QString text = qt(row.summary) + " " + qt(row.text);
    if (!std::isnan(row.least)) {
        text += QString(" From %1 to %2%3.")
                    .arg(row.least)
                    .arg(row.most)
                    .arg(row.unit.empty() ? QString() : " " + qt(row.unit));
    }
    return text.toHtmlEscaped();
}

QStringList list(const rust::Vec<rust::String>& texts) {
    QStringList list;
    for (const rust::String& text : texts) {
        list.append(qt(text));
    }
    return list;
}

void add_row(RichParameterList& dialog, const wovenfit::Parameter& row) {
    const QString name = qt(row.name);
    const QString value = qt(row.default_value);
    const QString shown = label(name, qt(row.unit));
    switch (row.kind) {
    case wovenfit::Kind::Switch:
        dialog.addParam(RichBool(name, value == "true", shown, tooltip(row)));
        break;
    case wovenfit::Kind::Integer:
        dialog.addParam(RichInt(name, value.toInt(), shown, tooltip(row)));
        break;
    case wovenfit::Kind::Choice: {
        const QStringList choices = list(row.choices);
        dialog.addParam(RichEnum(name, choices.indexOf(value), choices, shown, tooltip(row)));
        break;
    }
    default:
        dialog.addParam(RichFloat(name, static_cast<Scalarm>(value.toDouble()), shown, tooltip(row)));
    }
}

QString value_of(const RichParameterList& values, const wovenfit::Parameter& row) {
    const QString name = qt(row.name);
    switch (row.kind) {
    case wovenfit::Kind::Switch:
        return values.getBool(name) ? "true" : "false";
    case wovenfit::Kind::Integer:
        return QString::number(values.getInt(name));
    case wovenfit::Kind::Choice: {
        const int chosen = values.getEnum(name);
        const QStringList choices = list(row.choices);
        return chosen >= 0 && chosen < choices.size() ? choices[chosen] : QString::number(chosen);
    }
    default:
        return number(values, name);
    }
}

// "fabric.max_strain" in a script: "fabric_max_strain".
QString dialog_name(const wovenfit::Wish& wish) { return qt(wish.place).replace('.', '_'); }

void add_table(RichParameterList& dialog, const rust::Vec<wovenfit::Parameter>& table) {
    for (const wovenfit::Parameter& row : table) {
        add_row(dialog, row);
    }
}

} // namespace

RichParameterList flatten_dialog() {
    RichParameterList dialog;
    dialog.addParam(FileToOpen(
        names::design_file, "", {"*.json"}, "Design file",
        "A WovenFit design (.json): fabric, wanted pressures, orientation, seams, region; choose it by the ... "
        "button. Without one the seam and the orientation are found, and the fabric is what the fields below "
        "say."));
    dialog.addParam(FileToOpen(
        names::points_file, "", {"*.pp"}, "Picked points with pressures",
        "Points saved by MeshLab's PickPoints tool (.pp), each named after the pressure wanted there: "
        "15 mmHg, 2.0 kPa, or a number in the unit below. They are added to the design's pressures."));
    dialog.addParam(RichBool(
        names::from_quality, false, "Pressures from vertex quality",
        "Takes the quality of every vertex as the pressure wanted there; 0 asks for nothing. Painted "
        "vertices are condensed to points at least 10 mm apart, which the log says."));
    dialog.addParam(RichFloat(
        names::quality_scale, 1, "Pressure at quality 1",
        "What a vertex quality of 1 asks for, in the unit below: 1 if the quality is the pressure "
        "itself, 20 if it goes from 0 to 1 and 1 shall be 20."));
    dialog.addParam(RichEnum(names::pressure_unit, 0, PRESSURE_UNITS, "Unit of pressure",
                             "Of the quality, and of picked points whose names say none. 1 mmHg = "
                             "0.133322 kPa."));
    dialog.addParam(RichBool(names::selected_only, false, "Selected faces only",
                             "The brace covers the selected faces alone. Curvature is still read off the "
                             "whole layer."));
    dialog.addParam(RichEnum(names::field, 0,
                             {field_name(FIELDS[0]), field_name(FIELDS[1]), field_name(FIELDS[2])},
                             "Show on the pattern",
                             "What the vertex quality and the colours of the new layer are; red is most."));
    dialog.addParam(RichString(names::folder, "", "Folder for the files",
                               "Where the report (report.html, report.json), the pattern at true size and the "
                               "meshes (worn.obj, flat.obj) are written; made if there is none. Empty: no "
                               "files."));
    QString formats = "As what the pattern is written into the folder, with commas between them: ";
    for (const wovenfit::Format& format : wovenfit::pattern_formats()) {
        formats += QString("%1 (%2), ").arg(qt(format.name), qt(format.summary));
    }
    formats.chop(2);
    dialog.addParam(RichString(names::formats, "svg", "Formats of the pattern", formats.toHtmlEscaped() + "."));
    dialog.addParam(RichEnum(names::pattern_unit, 0, PATTERN_UNITS, "Unit of the pattern's files",
                             "Of the numbers in SVG and DXF, and of the lengths that stand on the pattern."));
    for (const wovenfit::Wish& wish : wovenfit::fabric_wishes()) {
        const QString tip = qt(wish.text) + " Empty: as the design file has it, else " +
                            qt(wish.default_value) + ".";
        dialog.addParam(RichString(dialog_name(wish), "", label(dialog_name(wish), ""), tip.toHtmlEscaped()));
    }
    add_table(dialog, wovenfit::parameters());
    return dialog;
}

RichParameterList check_dialog() {
    RichParameterList dialog;
    add_table(dialog, wovenfit::check_parameters());
    return dialog;
}

void set_parameters(wovenfit::Input& input, const rust::Vec<wovenfit::Parameter>& table,
                    const RichParameterList& values) {
    for (const wovenfit::Parameter& row : table) {
        input.set_parameter(row.name, rs(value_of(values, row)));
    }
}

void set_fabric(wovenfit::Input& input, const RichParameterList& values) {
    for (const wovenfit::Wish& wish : wovenfit::fabric_wishes()) {
        const QString value = values.getString(dialog_name(wish)).trimmed();
        if (!value.isEmpty()) {
            input.set_wish(wish.place, rs(value));
        }
    }
}

void set_formats(wovenfit::Input& input, const RichParameterList& values) {
    input.set_formats(rs(values.getString(names::formats)),
                      rs(PATTERN_UNITS.value(values.getEnum(names::pattern_unit))));
}

QString pressure_unit(const RichParameterList& values) {
    return PRESSURE_UNITS.value(values.getEnum(names::pressure_unit));
}

wovenfit::Field chosen_field(const RichParameterList& values) {
    const auto chosen = static_cast<size_t>(values.getEnum(names::field));
    return FIELDS[chosen < FIELDS.size() ? chosen : 0];
}

QString field_name(wovenfit::Field field) {
    switch (field) {
    case wovenfit::Field::WeftStrain:
        return "weft strain";
    case wovenfit::Field::Pressure:
        return "pressure (kPa)";
    default:
        return "warp strain";
    }
}

QString number(const RichParameterList& values, const QString& name) {
    std::array<char, 64> text{};
    const auto value = static_cast<float>(values.getFloat(name));
    const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
    return QString::fromLatin1(text.data(), static_cast<int>(end - text.data()));
}
