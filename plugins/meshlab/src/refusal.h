// Why a filter does not do what it was asked, and how the parts of the plugin speak.
#pragma once

#include <QString>
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

inline QString qt(const rust::String& text) {
    return QString::fromUtf8(text.data(), static_cast<int>(text.size()));
}

inline rust::String rs(const QString& text) {
    const QByteArray bytes = text.toUtf8();
    return rust::String(bytes.constData(), static_cast<size_t>(bytes.size()));
}
