// The plugin as MeshLab sees it: two filters.
#pragma once

#include <QObject>

#include "host.h"
#include "refusal.h"
#include "versions.h"

class WovenFitPlugin : public QObject, public HostPlugin {
    Q_OBJECT
#ifdef WOVENFIT_MESHLAB_2020
    Q_PLUGIN_METADATA(IID MESH_FILTER_INTERFACE_IID)
    Q_INTERFACES(MeshFilterInterface)
#else
    Q_PLUGIN_METADATA(IID FILTER_PLUGIN_IID)
    Q_INTERFACES(FilterPlugin)
#endif

public:
    enum Filter { Flatten, Check };

    WovenFitPlugin();

    QString pluginName() const override { return "WovenFit"; }
    QString filterName(int filter) const override;
    QString filterInfo(int filter) const override;
    HostArity filterArity(HostAction*) const override { return SINGLE_MESH; }
    int getPreConditions(HostAction*) const override { return MeshModel::MM_NONE; }
    int postCondition(HostAction* action) const override;

#ifdef WOVENFIT_MESHLAB_2020
    using MeshFilterInterface::filterInfo;
    using MeshFilterInterface::filterName;
    FilterClass getClass(QAction* action) override;
    void initParameterSet(QAction* action, MeshDocument& document, RichParameterList& dialog) override;
    bool applyFilter(QAction* action, MeshDocument& document, const RichParameterList& values,
                     vcg::CallBackPos* progress) override;
#else
    using FilterPlugin::filterInfo;
    using FilterPlugin::filterName;
    QString pythonFilterName(int filter) const override;
    QString vendor() const override { return "WovenFit"; }
    std::pair<std::string, bool> getMLVersion() const override { return built_for(); }
    FilterClass getClass(HostAction* action) const override;
    RichParameterList initParameterList(HostAction* action, const MeshDocument& document) override;
    std::map<std::string, QVariant> applyFilter(HostAction* action, const RichParameterList& values,
                                                MeshDocument& document, unsigned int& changed,
                                                vcg::CallBackPos* progress) override;
#endif

private:
    RichParameterList dialog(HostAction* action) const;
    FilterClass filter_class(HostAction* action) const;
    // Runs a filter; throws a Refusal, and nothing else.
    Results run(HostAction* action, const RichParameterList& values, MeshDocument& document,
                vcg::CallBackPos* progress);
    void say(const QString& line);

    bool running = false;
};
