// Why a filter does not do what it was asked, and how the parts of the plugin speak.
#pragma once

#include <QString>
#include <QStringList>
#include <QVariant>
#include <functional>
#include <map>
#include <stdexcept>
#include <string>

#include "wovenfit-meshlab/src/lib.rs.h"

// A text for people: what, where and what to do. Plain, not HTML.
class Refusal : public std::runtime_error {
public:
    explicit Refusal(const QString& text) : std::runtime_error(text.toStdString()) {}
};

// Says a line in MeshLab's log.
using Say = std::function<void(const QString&)>;

// What a script is given: names and values.
using Results = std::map<std::string, QVariant>;

// Says them in a line where the host gives a script nothing back: 2020.09.
inline void tell_results(const Results& results, const Say& say) {
#ifdef WOVENFIT_MESHLAB_2020
    QStringList values;
    for (const auto& [name, value] : results) {
        values.append(QString("%1 = %2").arg(QString::fromStdString(name), value.toString()));
    }
    say("results: " + values.join("; "));
#else
    Q_UNUSED(results)
    Q_UNUSED(say)
#endif
}

inline QString qt(const rust::String& text) {
    return QString::fromUtf8(text.data(), static_cast<int>(text.size()));
}

inline rust::String rs(const QString& text) {
    const QByteArray bytes = text.toUtf8();
    return rust::String(bytes.constData(), static_cast<size_t>(bytes.size()));
}
