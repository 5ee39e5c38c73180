// Files that the dialog names: read whole, written together.
#pragma once

#include <QByteArray>
#include <QString>

#include "refusal.h"

// The bytes of a file.
QByteArray read_file(const QString& file);

// Refuses a folder in which nothing can be written, before the long work.
void refuse_bad_folder(const QString& folder);

// Writes all files into a folder, which is made if there is none. Each appears whole or not at all, and
// none of them before all are written.
void write_files(const QString& folder, const rust::Vec<wovenfit::NamedFile>& files);
