// MeshLab's layers as buffers, and back.
#pragma once

#include <cstdint>
#include <vector>

#include "host.h"
#include "refusal.h"

// The current layer as the bridge takes it: what is not deleted, counted anew from 0, where the
// layer's transform shows it.
struct Given {
    std::vector<double> points;           // x, y, z of every vertex, in the layer's unit
    std::vector<uint32_t> triangles;      // three vertices of every triangle
    std::vector<double> quality;          // of every vertex
    std::vector<uint32_t> selected;       // the selected triangles
    std::vector<CVertexO*> vertex;        // which vertex of the layer each is
    std::vector<CFaceO*> face;            // which face of the layer each is
    bool mirrored = false;                // whether the transform mirrors: corners 1 and 2 are swapped

    // The corner of a face that is corner `k` of its triangle.
    int corner(int k) const { return mirrored && k != 0 ? 3 - k : k; }
};

// The current layer, if it has faces.
MeshModel& current_layer(MeshDocument& document);

// Whether a layer still is in a document.
bool is_in(MeshDocument& document, const MeshModel* layer);

Given read_layer(MeshModel& layer);

// Sets the texture coordinates of the given faces: two for each of three corners, in mm; NaN gives a
// corner none. How many faces have none.
size_t set_texture(MeshModel& layer, const Given& given, const rust::Vec<double>& corners);

// Adds the pattern as a layer: flat, in mm, `field` as quality and as colours, red for much. The layer's
// transform shows it beside the limb, in the limb's unit of so many mm; its coordinates stay in mm.
MeshModel& add_pattern(MeshDocument& document, const Given& given, double mm_per_unit,
                       const wovenfit::Pattern& pattern, const rust::Vec<double>& field);

// Selects vertices and faces, and nothing else.
void select_only(MeshModel& layer, const Given& given, const rust::Vec<wovenfit::Defect>& defects);
