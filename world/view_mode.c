/* The words of the renderer's views and back ends. */
#include "world/view_mode.h"

#include "world/enum_words.h"

WORDS(view_mode_name, view_mode, VIEW_COUNT, "chase", "map", "inside", "orbit", "free", "overhead")
WORDS(back_end_name, back_end, BACK_END_COUNT, "auto", "gl", "soft")
