// MeshLab's own file of picked points (.pp): a pressure is the name of its point.
#pragma once

#include <QString>
#include <array>
#include <vector>

struct PickedPressure {
    std::array<double, 3> at; // as the layer shows it, in its unit
    double value;
    QString unit;             // kPa or mmHg
};

// The active points of a file; `unit` is that of names without one. Refuses names that are no pressure,
// and the numbers that MeshLab itself gives to points.
std::vector<PickedPressure> read_picked_points(const QString& file, const QString& unit);
