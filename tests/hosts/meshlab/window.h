// Works MeshLab's window as a user does: dialog, Apply, result, an error; takes pictures of the screen.
#pragma once

class QObject;

// Starts once the window is there. The environment names a folder (WOVENFIT_WINDOW) and a design file
// (WOVENFIT_DESIGN); window.txt there says what held, dialog.png, result.png and error.png show it.
void work_the_window(QObject* parent);
