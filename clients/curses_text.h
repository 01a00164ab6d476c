/* Text on the screens of jolon-drive and jolon-monitor. Curses must be open. */
#ifndef JOLON_CLIENTS_CURSES_TEXT_H
#define JOLON_CLIENTS_CURSES_TEXT_H

/* Pairs of colours. Each program chooses colours that colour-blind people tell apart. */
enum curses_text_pair { PAIR_PLAIN, PAIR_BLUE, PAIR_RED, PAIR_WATER, PAIR_WARN };

/* Writes text in a row from column on, cut at the edge. Outside of the screen it writes nothing.
 * attributes: of curses. */
void curses_text_put(int row, int column, const char *text, unsigned attributes,
                     enum curses_text_pair pair);

#endif
