// What the two filters do, whichever MeshLab calls them. They refuse by exceptions; then the document
// is as it was.
#pragma once

#include "host.h"
#include "refusal.h"

Results flatten(const RichParameterList& values, MeshDocument& document, vcg::CallBackPos* progress,
                const Say& say);

Results check(const RichParameterList& values, MeshDocument& document, vcg::CallBackPos* progress,
              const Say& say);
