#include "layers.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include <vcg/complex/algorithms/update/color.h>
#include <vcg/complex/algorithms/update/selection.h>
#include <vcg/math/matrix44.h>

namespace {
const char* const PATTERN = "Pattern";
} // namespace

MeshModel& current_layer(MeshDocument& document) {
    MeshModel* layer = document.mm();
    if (layer == nullptr) {
        throw Refusal("there is no layer: open the scan of a limb first (File > Import Mesh)");
    }
    if (layer->cm.VN() == 0) {
        throw Refusal(QString("the layer \"%1\" is empty: open the scan of a limb, or make its layer "
                              "the current one")
                          .arg(layer->label()));
    }
    if (layer->cm.FN() == 0) {
        throw Refusal(QString("the layer \"%1\" has points and no faces: make a surface from them first, "
                              "for example by Filters > Remeshing, Simplification and Reconstruction > "
                              "Surface Reconstruction: Screened Poisson")
                          .arg(layer->label()));
    }
    if (layer->label().startsWith(PATTERN) && layer->cm.bbox.DimZ() == 0) {
        throw Refusal(QString("the current layer \"%1\" is a pattern: make the layer of the limb the current "
                              "one (click on it in the list of layers)")
                          .arg(layer->label()));
    }
    return *layer;
}

bool is_in(MeshDocument& document, const MeshModel* layer) {
    for (MeshModel* one = document.nextMesh(); one != nullptr; one = document.nextMesh(one)) {
        if (one == layer) {
            return true;
        }
    }
    return false;
}

Given read_layer(MeshModel& layer) {
    CMeshO& mesh = layer.cm;
    vcg::Matrix44d transform;
    transform.Import(mesh.Tr);
    vcg::Matrix44d identity;
    identity.SetIdentity();
    const bool moved = transform != identity;

    Given given;
    given.mirrored = moved && transform.Determinant() < 0;
    given.points.reserve(3 * static_cast<size_t>(mesh.VN()));
    given.triangles.reserve(3 * static_cast<size_t>(mesh.FN()));
    std::unordered_map<const CVertexO*, uint32_t> number;
    number.reserve(static_cast<size_t>(mesh.VN()));
    for (CVertexO& vertex : mesh.vert) {
        if (vertex.IsD()) {
            continue;
        }
        vcg::Point3d place;
        place.Import(vertex.P());
        if (moved) {
            place = transform * place;
        }
        number.emplace(&vertex, static_cast<uint32_t>(given.vertex.size()));
        given.vertex.push_back(&vertex);
        given.points.insert(given.points.end(), {place[0], place[1], place[2]});
        given.quality.push_back(vertex.Q());
    }
    for (CFaceO& face : mesh.face) {
        if (face.IsD()) {
            continue;
        }
        const auto triangle = static_cast<uint32_t>(given.face.size());
        given.face.push_back(&face);
        for (int k = 0; k < 3; k++) {
            const auto found = number.find(face.V(given.corner(k)));
            if (found == number.end()) {
                throw Refusal(QString("face %1 of the layer \"%2\" hangs on a deleted vertex: reload the "
                                      "layer from its file")
                                  .arg(triangle)
                                  .arg(layer.label()));
            }
            given.triangles.push_back(found->second);
        }
        if (face.IsS()) {
            given.selected.push_back(triangle);
        }
    }
    return given;
}

size_t set_texture(MeshModel& layer, const Given& given, const rust::Vec<double>& corners) {
    layer.updateDataMask(MeshModel::MM_WEDGTEXCOORD);
    size_t uncovered = 0;
    for (size_t t = 0; t < given.face.size(); t++) {
        const bool covered = !std::isnan(corners[6 * t]);
        uncovered += covered ? 0 : 1;
        for (int k = 0; k < 3; k++) {
            auto& texture = given.face[t]->WT(given.corner(k));
            const size_t at = 6 * t + 2 * static_cast<size_t>(k);
            texture.U() = covered ? static_cast<float>(corners[at]) : 0;
            texture.V() = covered ? static_cast<float>(corners[at + 1]) : 0;
            texture.N() = covered ? 0 : -1;
        }
    }
    return uncovered;
}

namespace {

// From the pattern's mm to the scene: to the right of the limb, half way along its other axes.
Matrix44m beside(const Given& given, double mm_per_unit, const rust::Vec<double>& pattern) {
    vcg::Box3d limb;
    for (size_t v = 0; v < given.vertex.size(); v++) {
        limb.Add({given.points[3 * v], given.points[3 * v + 1], given.points[3 * v + 2]});
    }
    double height = 0;
    for (size_t v = 1; v < pattern.size(); v += 2) {
        height = std::max(height, pattern[v]);
    }
    const vcg::Point3d middle = limb.Center();
    const vcg::Point3d corner(limb.max[0] + 0.25 * limb.DimX(), middle[1] - 0.5 * height / mm_per_unit,
                              middle[2]);
    vcg::Matrix44d scale;
    vcg::Matrix44d shift;
    scale.SetScale(1 / mm_per_unit, 1 / mm_per_unit, 1 / mm_per_unit);
    shift.SetTranslate(corner);
    Matrix44m transform;
    transform.Import(shift * scale);
    return transform;
}

} // namespace

MeshModel& add_pattern(MeshDocument& document, const Given& given, double mm_per_unit,
                       const wovenfit::Pattern& pattern, const rust::Vec<double>& field) {
    const rust::Vec<double> places = pattern.coordinates();
    const rust::Vec<uint32_t> triangles = pattern.triangles();
    MeshModel& layer = *document.addNewMesh("", PATTERN, true);
    layer.updateDataMask(MeshModel::MM_VERTQUALITY | MeshModel::MM_VERTCOLOR);
    CMeshO& mesh = layer.cm;
    auto vertex = vcg::tri::Allocator<CMeshO>::AddVertices(mesh, places.size() / 2);
    for (size_t v = 0; v < places.size() / 2; v++, ++vertex) {
        vertex->P() = CMeshO::CoordType(static_cast<Scalarm>(places[2 * v]),
                                        static_cast<Scalarm>(places[2 * v + 1]), 0);
        vertex->Q() = static_cast<CVertexO::QualityType>(field[v]);
    }
    auto face = vcg::tri::Allocator<CMeshO>::AddFaces(mesh, triangles.size() / 3);
    for (size_t t = 0; t < triangles.size() / 3; t++, ++face) {
        for (int k = 0; k < 3; k++) {
            face->V(k) = &mesh.vert[triangles[3 * t + static_cast<size_t>(k)]];
        }
    }
    const auto [least, most] = std::minmax_element(field.begin(), field.end());
    // MeshLab's ramp goes from red to blue; a brace's red is where most is.
    vcg::tri::UpdateColor<CMeshO>::PerVertexQualityRamp(
        mesh, static_cast<CVertexO::QualityType>(*most), static_cast<CVertexO::QualityType>(*least));
    mesh.Tr = beside(given, mm_per_unit, places);
    update_box_and_normals(layer);
    return layer;
}

void select_only(MeshModel& layer, const Given& given, const rust::Vec<wovenfit::Defect>& defects) {
    CMeshO& mesh = layer.cm;
    vcg::tri::UpdateSelection<CMeshO>::VertexClear(mesh);
    vcg::tri::UpdateSelection<CMeshO>::FaceClear(mesh);
    for (const wovenfit::Defect& defect : defects) {
        for (const uint32_t v : defect.vertices) {
            if (v < given.vertex.size()) {
                given.vertex[v]->SetS();
            }
        }
        for (const uint32_t t : defect.triangles) {
            if (t < given.face.size()) {
                given.face[t]->SetS();
            }
        }
    }
    mesh.svn = static_cast<int>(vcg::tri::UpdateSelection<CMeshO>::VertexCount(mesh));
    mesh.sfn = static_cast<int>(vcg::tri::UpdateSelection<CMeshO>::FaceCount(mesh));
}
