#include "versions.h"

#ifdef WOVENFIT_MESHLAB_2020
#include <common/mlapplication.h>
#include <dlfcn.h>
#endif

#define WOVENFIT_TEXT_OF(macro) WOVENFIT_TEXT(macro)
#define WOVENFIT_TEXT(text) #text

std::pair<std::string, bool> built_for() {
    const std::string scalar = WOVENFIT_TEXT_OF(WOVENFIT_BUILT_SCALAR);
    return {WOVENFIT_TEXT_OF(WOVENFIT_BUILT_VERSION), scalar == "double"};
}

#ifdef WOVENFIT_MESHLAB_2020

namespace {

// A function of the host whose name holds the scalar type: it exists for one of the two alone.
bool host_has_doubles() {
    return dlsym(RTLD_DEFAULT, "_Z14Matrix44mToXMLRN3vcg8Matrix44IdEER12QDomDocument") != nullptr;
}

QString in_words(const QString& version, bool doubles) {
    return QString("MeshLab %1 with %2 precision").arg(version, doubles ? "double" : "single");
}

} // namespace

QString mismatch() {
    const auto [version, doubles] = built_for();
    const QString own = in_words(QString::fromStdString(version), doubles);
    const QString host = in_words(MeshLabApplication::appVer(), host_has_doubles());
    if (own == host) {
        return {};
    }
    return QString("this plugin was built for %1, and this is %2: build and install it again for this "
                   "MeshLab with `python3 plugins/meshlab/install.py`")
        .arg(own, host);
}

#else

QString mismatch() { return {}; }

#endif
