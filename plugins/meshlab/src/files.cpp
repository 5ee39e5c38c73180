#include "files.h"

#include <QDir>
#include <QFile>
#include <QFileInfo>
#include <QSaveFile>
#include <memory>
#include <vector>

QByteArray read_file(const QString& file) {
    if (!QFileInfo::exists(file)) {
        throw Refusal(QString("%1: there is no such file").arg(file));
    }
    if (QFileInfo(file).isDir()) {
        throw Refusal(QString("%1: this is a folder: give a file").arg(file));
    }
    QFile opened(file);
    if (!opened.open(QIODevice::ReadOnly)) {
        throw Refusal(QString("%1: cannot be read: %2").arg(file, opened.errorString()));
    }
    return opened.readAll();
}

void refuse_bad_folder(const QString& folder) {
    QFileInfo place(folder);
    if (place.exists() && !place.isDir()) {
        throw Refusal(QString("%1: this is a file: give a folder for the results").arg(folder));
    }
    while (!place.exists() && !place.isRoot()) {
        place = QFileInfo(place.dir().absolutePath());
    }
    if (!place.isDir() || !place.isWritable()) {
        throw Refusal(QString("%1: nothing can be written there: give another folder for the results")
                          .arg(folder));
    }
}

void write_files(const QString& folder, const rust::Vec<wovenfit::NamedFile>& files) {
    const auto refuse = [&](const QString& name, const QString& why) {
        throw Refusal(QString("%1 cannot be written into %2: %3").arg(name, folder, why));
    };
    if (!QDir().mkpath(folder)) {
        refuse("the results", "the folder cannot be made");
    }
    std::vector<std::unique_ptr<QSaveFile>> written;
    for (const wovenfit::NamedFile& file : files) {
        const QString name = qt(file.name);
        auto save = std::make_unique<QSaveFile>(QDir(folder).filePath(name));
        const auto size = static_cast<qint64>(file.bytes.size());
        if (!save->open(QIODevice::WriteOnly) || save->write(reinterpret_cast<const char*>(file.bytes.data()), size) != size) {
            refuse(name, save->errorString());
        }
        written.push_back(std::move(save));
    }
    for (const auto& save : written) {
        if (!save->commit()) {
            refuse(save->fileName(), save->errorString());
        }
    }
}
