// For which MeshLab the plugin was built, and whether this one is it.
#pragma once

#include <QString>
#include <string>
#include <utility>

// The version and whether coordinates are doubles: what MeshLab 2021.05 and later compare with their
// own before they use a plugin.
std::pair<std::string, bool> built_for();

// Empty, or why this MeshLab cannot use the plugin and what to do. Later hosts never load such a
// plugin; 2020.09 loads any, so that each call asks here first.
QString mismatch();
