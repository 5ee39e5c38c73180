// The two plugin interfaces of MeshLab, as one: 2020.09 (`MeshFilterInterface`, a bool and an error
// text) and 2021.05 and later (`FilterPlugin`, results and exceptions). All that differs in names is
// here; what differs in signatures is in plugin.h.
#pragma once

#ifdef WOVENFIT_MESHLAB_2020

#include <common/filter_parameter/rich_parameter_list.h>
#include <common/interfaces.h>

using HostPlugin = MeshFilterInterface;
using HostAction = QAction;
using HostArity = MeshFilterInterface::FILTER_ARITY;
using FileToOpen = RichOpenFile;
using Scalarm = MESHLAB_SCALAR;

inline void update_box_and_normals(MeshModel& layer) { layer.UpdateBoxAndNormals(); }

#else

#include <common/ml_document/mesh_document.h>
#include <common/parameters/rich_parameter_list.h>
#include <common/plugins/interfaces/filter_plugin.h>

using HostPlugin = FilterPlugin;
using HostAction = const QAction;
using HostArity = FilterPlugin::FilterArity;
using FileToOpen = RichFileOpen;

inline void update_box_and_normals(MeshModel& layer) { layer.updateBoxAndNormals(); }

#endif

static_assert(sizeof(CMeshO::CoordType) == 3 * sizeof(MESHLAB_SCALAR),
              "the headers are those of a MeshLab with another scalar type");
