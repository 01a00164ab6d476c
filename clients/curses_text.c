/* Text on the screens of jolon-drive and jolon-monitor. */
#include "clients/curses_text.h"

#include <curses.h>

void curses_text_put(int row, int column, const char *text, unsigned attributes,
                     enum curses_text_pair pair)
{
    if (row < 0 || row >= LINES || column >= COLS)
        return;
    (void)attr_set(attributes, (short)pair, NULL);
    (void)mvaddnstr(row, column, text, COLS - column);
    (void)attr_set(A_NORMAL, PAIR_PLAIN, NULL);
}
