// MeshLab 2020.09 gives a filter's dialog the height of all its rows, and the Apply button of a long one
// lies below the screen. Later versions scroll.
#pragma once

// Makes the dialog that is about to open scroll, if there is a window.
void scroll_next_dialog();
