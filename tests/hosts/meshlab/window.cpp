#include "window.h"

#include <QAction>
#include <QApplication>
#include <QComboBox>
#include <QDir>
#include <QElapsedTimer>
#include <QFile>
#include <QFileDialog>
#include <QLineEdit>
#include <QMainWindow>
#include <QMenu>
#include <QMessageBox>
#include <QProgressBar>
#include <QPushButton>
#include <QScreen>
#include <QTextStream>
#include <QTimer>
#include <QTreeWidget>
#include <cstdlib>

namespace {

constexpr int EVERY_MS = 50;
constexpr int PATIENCE_MS = 60000;
constexpr int DIALOG_WIDTH = 480;

class User : public QObject {
public:
    explicit User(QObject* parent) : QObject(parent), folder(qEnvironmentVariable("WOVENFIT_WINDOW")) {
        connect(&timer, &QTimer::timeout, this, [this] { look(); });
        timer.start(EVERY_MS);
        clock.start();
    }

private:
    enum Step { Opening, Dialog, Choosing, Filled, Computing, Shown, Wrong, Refused };

    // Looks at the window and does the next thing. What blocks is done by timers of its own, so that
    // this one goes on meanwhile.
    void look() {
        if (clock.elapsed() > PATIENCE_MS) {
            say(false, QString("step %1 is not over after a minute").arg(step));
            end();
        }
        if (QMainWindow* found = window(); found != nullptr) {
            main = found;
        }
        if (main == nullptr) {
            return;
        }
        switch (step) {
        case Opening:
            if (has_layer("arm")) {
                // Beside the dialog, which opens at the left.
                const QSize screen = QGuiApplication::primaryScreen()->size();
                main->setGeometry(DIALOG_WIDTH, 0, screen.width() - DIALOG_WIDTH, screen.height());
                next(Dialog, "WovenFit: Flatten to Pattern");
            }
            break;
        case Dialog:
            if (QWidget* dialog = filter_dialog(); dialog != nullptr && waited(500)) {
                say(dialog->findChildren<QLineEdit*>().size() > 20, "the dialog has the parameters");
                say(dialog->height() < QGuiApplication::primaryScreen()->size().height(),
                    QString("the dialog fits the screen (%1 pixels)").arg(dialog->height()));
                show_pressure(dialog);
                next(Choosing, {});
                // The first "..." is the design file's: a name that is typed MeshLab does not see.
                QTimer::singleShot(0, this, [this] { press("..."); });
            }
            break;
        case Choosing:
            if (auto* files = qobject_cast<QFileDialog*>(QApplication::activeModalWidget()); files != nullptr) {
                files->findChild<QLineEdit*>()->setText(qEnvironmentVariable("WOVENFIT_DESIGN"));
                next(Filled, {});
                QTimer::singleShot(0, files, [files] { static_cast<QDialog*>(files)->accept(); });
            }
            break;
        case Filled:
            if (QApplication::activeModalWidget() == nullptr && waited(500)) {
                picture("dialog.png");
                step = Computing;
                QTimer::singleShot(0, this, [this] { press("Apply"); });
            }
            break;
        case Computing:
            for (const QProgressBar* bar : main->findChildren<QProgressBar*>()) {
                farthest = std::max(farthest, bar->value());
                values.insert(bar->value());
            }
            if (has_layer("Pattern")) {
                say(values.size() > 2 && farthest > 20, QString("the bar moves (%1 values)").arg(values.size()));
                next(Shown, "Reset Trackball");
            }
            break;
        case Shown:
            if (waited(1500)) {
                picture("result.png");
                close_dialog();
                next(Wrong, "WovenFit: Flatten to Pattern");
            }
            break;
        case Wrong:
            // The pattern is the current layer now, and no limb.
            if (filter_dialog() != nullptr && waited(500)) {
                next(Refused, {});
                QTimer::singleShot(0, this, [this] { press("Apply"); });
            }
            break;
        case Refused:
            if (auto* box = qobject_cast<QMessageBox*>(QApplication::activeModalWidget()); box != nullptr) {
                if (!waited(500)) {
                    break;
                }
                picture("error.png");
                say(box->text().contains("&quot;Pattern&quot; is a pattern: make the layer"),
                    "an error says what to do: " + box->text());
                end();
            }
            break;
        }
    }

    static QMainWindow* window() {
        for (QWidget* widget : QApplication::topLevelWidgets()) {
            auto* found = qobject_cast<QMainWindow*>(widget);
            if (found != nullptr && found->isVisible()) {
                return found;
            }
        }
        return nullptr;
    }

    bool has_layer(const QString& name) const {
        for (const QTreeWidget* tree : main->findChildren<QTreeWidget*>()) {
            if (!tree->findItems(name, Qt::MatchContains | Qt::MatchRecursive, 1).isEmpty() ||
                !tree->findItems(name, Qt::MatchContains | Qt::MatchRecursive, 2).isEmpty()) {
                return true;
            }
        }
        return false;
    }

    // The dock with a filter's parameters.
    QWidget* filter_dialog() const {
        for (QWidget* widget : main->findChildren<QWidget*>()) {
            if (QString(widget->metaObject()->className()) == "MeshlabStdDialog" && widget->isVisible()) {
                return widget;
            }
        }
        return nullptr;
    }

    static void show_pressure(QWidget* dialog) {
        for (QComboBox* box : dialog->findChildren<QComboBox*>()) {
            if (const int at = box->findText("pressure (kPa)"); at >= 0) {
                box->setCurrentIndex(at);
            }
        }
    }

    void press(const QString& name) const {
        if (QWidget* dialog = filter_dialog(); dialog != nullptr) {
            for (QPushButton* button : dialog->findChildren<QPushButton*>()) {
                if (button->text() == name) {
                    button->click();
                    return;
                }
            }
        }
    }

    void close_dialog() const {
        QTimer::singleShot(0, this, [this] { press("Close"); });
    }

    // Goes to a step; an action of the menus is triggered for it.
    void next(Step to, const QString& action) {
        step = to;
        since.restart();
        if (action.isEmpty()) {
            return;
        }
        for (QMenu* menu : main->findChildren<QMenu*>()) {
            for (QAction* one : menu->actions()) {
                if (one->text().remove('&').startsWith(action)) {
                    QTimer::singleShot(0, one, &QAction::trigger);
                    return;
                }
            }
        }
        say(false, "no menu has " + action);
    }

    bool waited(int milliseconds) { return since.elapsed() > milliseconds; }

    void picture(const QString& name) const {
        QGuiApplication::primaryScreen()->grabWindow(0).save(QDir(folder).filePath(name));
    }

    void say(bool good, const QString& what) { verdict += (good ? "ok: " : "FAILED: ") + what + "\n"; }

    void end() {
        QFile file(QDir(folder).filePath("window.txt"));
        if (file.open(QIODevice::WriteOnly)) {
            file.write(verdict.toUtf8());
            file.close();
        }
        // MeshLab would ask whether the layers are to be saved.
        std::_Exit(verdict.contains("FAILED") ? 1 : 0);
    }

    QString folder;
    QTimer timer;
    QElapsedTimer clock;
    QElapsedTimer since;
    QMainWindow* main = nullptr;
    Step step = Opening;
    int farthest = 0;
    QSet<int> values;
    QString verdict;
};

} // namespace

void work_the_window(QObject* parent) {
    QTimer::singleShot(0, parent, [parent] { new User(parent); });
}
