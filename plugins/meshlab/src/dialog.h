// The dialogs, made from the core's table of parameters and the schema of the design file; the way from
// a filled dialog to the core.
#pragma once

#include "host.h"
#include "refusal.h"

// The names of what is MeshLab's own in the dialogs.
namespace names {
inline const char* const design_file = "design_file";
inline const char* const points_file = "picked_points_file";
inline const char* const from_quality = "pressures_from_quality";
inline const char* const quality_scale = "quality_scale";
inline const char* const pressure_unit = "pressure_unit";
inline const char* const selected_only = "selected_faces_only";
inline const char* const field = "field";
inline const char* const folder = "output_folder";
inline const char* const formats = "pattern_formats";
inline const char* const pattern_unit = "pattern_unit";
} // namespace names

// The dialog of "Flatten to Pattern".
RichParameterList flatten_dialog();

// The dialog of "Check Surface".
RichParameterList check_dialog();

// The table's values of a filled dialog.
void set_parameters(wovenfit::Input& input, const rust::Vec<wovenfit::Parameter>& table,
                    const RichParameterList& values);

// The fabric's values that were filled in; the others stay as the design has them.
void set_fabric(wovenfit::Input& input, const RichParameterList& values);

// As what the pattern is written, and in which unit.
void set_formats(wovenfit::Input& input, const RichParameterList& values);

// The unit of pressure that was chosen: kPa or mmHg.
QString pressure_unit(const RichParameterList& values);

// The field that was chosen, and its name for people.
wovenfit::Field chosen_field(const RichParameterList& values);
QString field_name(wovenfit::Field field);

// A number of the dialog as the shortest text that reads back as it. Every MeshLab keeps these numbers in
// 32 bits: 0.01, not 0.00999999978.
QString number(const RichParameterList& values, const QString& name);
