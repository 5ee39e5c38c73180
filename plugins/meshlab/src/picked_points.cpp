#include "picked_points.h"

#include <QDomDocument>
#include <QRegularExpression>
#include <cmath>

#include "files.h"
#include "refusal.h"

namespace {

double coordinate(const QDomElement& point, const char* axis, int number, const QString& file) {
    bool is_number = false;
    const double value = point.attribute(axis).toDouble(&is_number);
    if (!is_number || !std::isfinite(value)) {
        throw Refusal(QString("%1: point %2 has no coordinate %3: save the picked points anew")
                          .arg(file)
                          .arg(number)
                          .arg(axis));
    }
    return value;
}

// Names as MeshLab gives them are no wishes of anyone: 0, 1, 2, … in their order.
void refuse_automatic_names(const QStringList& names, const QString& file) {
    for (int i = 0; i < names.size(); i++) {
        if (names[i] != QString::number(i)) {
            return;
        }
    }
    throw Refusal(QString("%1: the points have the names that MeshLab gave them (0, 1, …): rename each to "
                          "the pressure that is wanted there, such as \"15 mmHg\" or \"2.0 kPa\"")
                      .arg(file));
}

} // namespace

std::vector<PickedPressure> read_picked_points(const QString& file, const QString& unit) {
    QDomDocument document;
    QString problem;
    int line = 0;
    if (!document.setContent(read_file(file), &problem, &line) ||
        document.documentElement().nodeName() != "PickedPoints") {
        throw Refusal(QString("%1: this is no file of picked points (line %2: %3): give one that MeshLab's "
                              "PickPoints tool has saved")
                          .arg(file)
                          .arg(line)
                          .arg(problem.isEmpty() ? "no PickedPoints" : problem));
    }
    static const QRegularExpression pressure("^\\s*(\\d+(?:\\.\\d*)?|\\.\\d+)\\s*(kPa|mmHg)?\\s*$",
                                             QRegularExpression::CaseInsensitiveOption);
    std::vector<PickedPressure> points;
    QStringList names;
    int number = 0;
    for (QDomElement point = document.documentElement().firstChildElement("point"); !point.isNull();
         point = point.nextSiblingElement("point")) {
        number++;
        if (point.attribute("active") == "0") {
            continue;
        }
        const QString name = point.attribute("name");
        const auto match = pressure.match(name);
        if (!match.hasMatch()) {
            throw Refusal(QString("%1: point %2 is called \"%3\", which is no pressure: name it after the "
                                  "pressure that is wanted there, such as \"15 mmHg\" or \"2.0 kPa\", or make "
                                  "it inactive")
                              .arg(file)
                              .arg(number)
                              .arg(name));
        }
        const bool says_mmhg = match.captured(2).compare("mmHg", Qt::CaseInsensitive) == 0;
        const QString own = match.captured(2).isEmpty() ? unit : says_mmhg ? "mmHg" : "kPa";
        names.append(name);
        points.push_back({{coordinate(point, "x", number, file), coordinate(point, "y", number, file),
                           coordinate(point, "z", number, file)},
                          match.captured(1).toDouble(),
                          own});
    }
    if (points.empty()) {
        throw Refusal(QString("%1: there is no active point in this file: pick the places where pressure is "
                              "wanted and save them")
                          .arg(file));
    }
    refuse_automatic_names(names, file);
    return points;
}
