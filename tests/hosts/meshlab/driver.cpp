// A second plugin, for the tests alone: it does to the filters what only code inside MeshLab can do.
// As a filter of meshlabserver it calls them as no user can; with WOVENFIT_WINDOW set it works MeshLab's
// window as a user does and takes pictures.
#include <QDir>
#include <QObject>
#include <QPluginLoader>
#include <limits>

#include "../../../plugins/meshlab/src/host.h"
#include "window.h"
#include "wovenfit-meshlab/src/lib.rs.h"

namespace {

MeshFilterInterface* tested = nullptr;
QAction* flatten = nullptr;
MeshDocument* watched = nullptr;
QString nested_error;
bool nested_result = true;

bool run(MeshDocument& document, vcg::CallBackPos* progress) {
    RichParameterList values;
    tested->initParameterSet(flatten, document, values);
    return tested->applyFilter(flatten, document, values, progress);
}

bool quiet(const int, const char*) { return true; }

bool calling_again(const int, const char*) {
    if (nested_error.isEmpty()) {
        nested_result = run(*watched, quiet);
        nested_error = tested->errorMsg();
    }
    return true;
}

bool deleting(const int, const char*) {
    while (!watched->meshList.isEmpty()) {
        watched->delMesh(watched->meshList.last());
    }
    return true;
}

bool stopping(const int, const char*) { return false; }

} // namespace

class Driver : public QObject, public MeshFilterInterface {
    Q_OBJECT
    Q_PLUGIN_METADATA(IID MESH_FILTER_INTERFACE_IID)
    Q_INTERFACES(MeshFilterInterface)

public:
    Driver() {
        typeList = {0};
        actionList = {new QAction(Driver::filterName(0), this)};
        if (!qEnvironmentVariableIsEmpty("WOVENFIT_WINDOW")) {
            work_the_window(this);
        }
    }

    QString filterName(FilterIDType) const override { return "WovenFit test: From Inside"; }
    QString filterInfo(FilterIDType) const override { return "For the tests alone."; }
    FilterClass getClass(QAction*) override { return Measure; }
    FILTER_ARITY filterArity(QAction*) const override { return SINGLE_MESH; }
    using MeshFilterInterface::filterInfo;
    using MeshFilterInterface::filterName;
    void initParameterSet(QAction*, MeshDocument&, RichParameterList&) override {}

    bool applyFilter(QAction*, MeshDocument& document, const RichParameterList&, vcg::CallBackPos*) override {
        // The same library gives the same object.
        QPluginLoader loader(QDir(qApp->applicationDirPath())
                                 .filePath("../lib/x86_64-linux-gnu/meshlab/plugins/libfilter_wovenfit.so"));
        tested = qobject_cast<MeshFilterInterface*>(loader.instance());
        flatten = tested->AC(tested->types().first());
        watched = &document;
        const int layers = document.meshList.size();
        const int faces = document.mm()->cm.FN();

        hold(run(document, calling_again), "a run is not disturbed by a nested call");
        hold(!nested_result && nested_error.contains("still running"), "a nested call is refused");
        hold(document.meshList.size() == layers + 1, "and makes no layer");
        document.setCurrentMesh(document.meshList.first()->id());

        hold(!run(document, stopping) && tested->errorMsg() == "cancelled", "a host that says stop is heard");
        hold(document.meshList.size() == layers + 1 && document.mm()->cm.FN() == faces, "nothing is half-built");

        MeshDocument empty;
        hold(!run(empty, quiet) && tested->errorMsg().contains("there is no layer"), "an empty document");
        hold(!run(document, deleting) && tested->errorMsg().contains("was changed or closed"),
             "a layer that is closed meanwhile");
        document.addNewMesh("", "left", true);

        // More values than vertices: a fault, not a refusal.
        QString panic;
        try {
            const double values[] = {std::numeric_limits<double>::quiet_NaN()};
            wovenfit::new_input()->paint({values, 1}, 1, "kPa");
        } catch (const std::exception& error) {
            panic = error.what();
        }
        hold(panic.startsWith("a fault of WovenFit, please report it"), "a panic is an exception");
        return true;
    }

private:
    void hold(bool good, const char* what) {
        Log(GLLogStream::FILTER, (std::string(good ? "ok: " : "FAILED: ") + what +
                                  (good ? "" : ": " + tested->errorMsg().toStdString())));
    }
};

#include "driver.moc"
