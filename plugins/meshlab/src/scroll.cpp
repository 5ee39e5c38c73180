#include "scroll.h"

#ifdef WOVENFIT_MESHLAB_2020

#include <QApplication>
#include <QDockWidget>
#include <QScreen>
#include <QScrollArea>
#include <QScrollBar>
#include <QTimer>
#include <algorithm>

namespace {

// The part of the screen's height that a dialog may take.
constexpr double SHARE = 0.8;

void scroll(QDockWidget* dock) {
    QWidget* rows = dock->widget();
    if (rows == nullptr || qobject_cast<QScrollArea*>(rows) != nullptr) {
        return;
    }
    const QSize wanted = rows->sizeHint();
    const int most = static_cast<int>(SHARE * QGuiApplication::primaryScreen()->availableGeometry().height());
    if (wanted.height() <= most) {
        return;
    }
    // MeshLab deletes the rows itself when another filter comes; the empty area goes with the dock.
    auto* area = new QScrollArea(dock);
    area->setWidgetResizable(true);
    area->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
    area->setWidget(rows);
    dock->setMinimumSize(0, 0);
    dock->setWidget(area);
    rows->show();
    area->show();
    const int width = wanted.width() + area->verticalScrollBar()->sizeHint().width() + 2 * area->frameWidth();
    area->setMinimumWidth(width);
    dock->resize(width, most);
    // The buttons, at the end, are what one must find.
    QObject::connect(rows, &QObject::destroyed, area, &QObject::deleteLater);
}

} // namespace

void scroll_next_dialog() {
    if (qobject_cast<QApplication*>(QCoreApplication::instance()) == nullptr) {
        return;
    }
    QTimer::singleShot(0, qApp, [] {
        for (QWidget* widget : QApplication::allWidgets()) {
            auto* dock = qobject_cast<QDockWidget*>(widget);
            if (dock != nullptr && dock->isVisible() && dock->inherits("MeshlabStdDialog")) {
                scroll(dock);
            }
        }
    });
}

#else

void scroll_next_dialog() {}

#endif
