#include "plugin.h"

#include <QApplication>
#include <QMainWindow>
#include <algorithm>

#include "dialog.h"
#include "filters.h"
#include "scroll.h"

namespace {

// Whether MeshLab has a window: its dialogs and its log show HTML then. A script is given plain text.
bool in_window() {
    if (qobject_cast<QApplication*>(QCoreApplication::instance()) == nullptr) {
        return false;
    }
    const auto widgets = QApplication::topLevelWidgets();
    return std::any_of(widgets.begin(), widgets.end(),
                       [](const QWidget* one) { return qobject_cast<const QMainWindow*>(one) != nullptr; });
}

QString for_dialog(const QString& text) {
    return in_window() ? text.toHtmlEscaped().replace('\n', "<br>") : text;
}

// A line of the log; a table keeps its columns.
QString for_log(const QString& line) {
    const QChar hard_space(0x00a0);
    return in_window() ? line.toHtmlEscaped().replace("  ", QString(2, hard_space)) : line;
}

// A flag that is up as long as this lives.
class Raised {
public:
    explicit Raised(bool& flag) : flag(flag) { flag = true; }
    ~Raised() { flag = false; }
    Raised(const Raised&) = delete;
    Raised& operator=(const Raised&) = delete;

private:
    bool& flag;
};

} // namespace

WovenFitPlugin::WovenFitPlugin() {
    typeList = {Flatten, Check};
    for (const int filter : typeList) {
        // Not filterName(action), which would ask the action's text.
        actionList.push_back(new QAction(WovenFitPlugin::filterName(filter), this));
    }
}

QString WovenFitPlugin::filterName(int filter) const {
    return filter == Flatten ? "WovenFit: Flatten to Pattern" : "WovenFit: Check Surface";
}

QString WovenFitPlugin::filterInfo(int filter) const {
    if (filter == Check) {
        return "Says what a scanned limb is (size, girths, openings, curvature) and every defect that stops "
               "it from being flattened, with its place and what to do, in the log; selects the faces and "
               "vertices that the defects are about.";
    }
    return "From the scan of a limb to the flat pattern of an elastic brace that, by the model of its fabric, "
           "presses as asked: a new layer, in mm. The log has the table of pressures and the warnings. "
           "Pressures are computed, not measured.<br>See: <i>Wang &amp; Tang</i>, <b>\"Woven Model Based "
           "Geometric Design of Elastic Medical Braces\"</b>.";
}

int WovenFitPlugin::postCondition(HostAction* action) const {
    // With VERTNUMBER MeshLab offers no preview, which would be another run.
    return ID(action) == Flatten
               ? MeshModel::MM_WEDGTEXCOORD | MeshModel::MM_VERTNUMBER | MeshModel::MM_FACENUMBER
               : MeshModel::MM_VERTFLAGSELECT | MeshModel::MM_FACEFLAGSELECT | MeshModel::MM_VERTNUMBER;
}

HostPlugin::FilterClass WovenFitPlugin::filter_class(HostAction* action) const {
    return ID(action) == Flatten ? Texture : FilterClass(Selection | Cleaning);
}

RichParameterList WovenFitPlugin::dialog(HostAction* action) const {
    return ID(action) == Flatten ? flatten_dialog() : check_dialog();
}

Results WovenFitPlugin::run(HostAction* action, const RichParameterList& values, MeshDocument& document,
                            vcg::CallBackPos* progress) {
    const Say line = [this](const QString& text) { say(text); };
    try {
        if (const QString other = mismatch(); !other.isEmpty()) {
            throw Refusal(other);
        }
        if (running) {
            throw Refusal("a filter of WovenFit is still running: wait until it has ended");
        }
        const Raised raised(running);
        return ID(action) == Flatten ? flatten(values, document, progress, line)
                                     : check(values, document, progress, line);
    } catch (const std::exception& error) {
        // meshlabserver shows no error text of a filter: the log has it, too.
        const QString text = QString::fromUtf8(error.what());
        say("error: " + text);
        throw Refusal(text);
    } catch (...) {
        throw Refusal("a fault of WovenFit without a text: please report it with the mesh and the settings");
    }
}

#ifdef WOVENFIT_MESHLAB_2020

HostPlugin::FilterClass WovenFitPlugin::getClass(QAction* action) { return filter_class(action); }

void WovenFitPlugin::initParameterSet(QAction* action, MeshDocument&, RichParameterList& parameters) {
    // In another MeshLab the filter has no dialog: it is run at once and says why not.
    if (mismatch().isEmpty()) {
        parameters = dialog(action);
        scroll_next_dialog();
    }
}

bool WovenFitPlugin::applyFilter(QAction* action, MeshDocument& document, const RichParameterList& values,
                                 vcg::CallBackPos* progress) {
    try {
        run(action, values, document, progress);
        return true;
    } catch (const std::exception& refused) {
        errorMessage = for_dialog(QString::fromUtf8(refused.what()));
        return false;
    }
}

void WovenFitPlugin::say(const QString& line) {
    Log(GLLogStream::FILTER, for_log(line).toUtf8().constData());
}

#else

QString WovenFitPlugin::pythonFilterName(int filter) const {
    return filter == Flatten ? "wovenfit_flatten_to_pattern" : "wovenfit_check_surface";
}

HostPlugin::FilterClass WovenFitPlugin::getClass(HostAction* action) const { return filter_class(action); }

RichParameterList WovenFitPlugin::initParameterList(HostAction* action, const MeshDocument&) {
    return dialog(action);
}

std::map<std::string, QVariant> WovenFitPlugin::applyFilter(HostAction* action,
                                                            const RichParameterList& values,
                                                            MeshDocument& document, unsigned int& changed,
                                                            vcg::CallBackPos* progress) {
    try {
        changed = static_cast<unsigned int>(postCondition(action));
        return run(action, values, document, progress);
    } catch (const std::exception& refused) {
        throw MLException(for_dialog(QString::fromUtf8(refused.what())));
    }
}

void WovenFitPlugin::say(const QString& line) {
    log(GLLogStream::FILTER, for_log(line).toUtf8().constData());
}

#endif
