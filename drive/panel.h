/* What the driver reads: the vehicle's statistics (thesis row 13) and what goes with them, as text.
 */
#ifndef JOLON_DRIVE_PANEL_H
#define JOLON_DRIVE_PANEL_H

#include "drive/session.h"

#define PANEL_ROWS    16
#define PANEL_COLUMNS 36
#define PANEL_LINE    512u

/* Everything in one line of key=value, as the table has it; for scripts. */
void panel_line(char line[PANEL_LINE], const struct session *session);

/* Who, where, in which world: the line above all. */
void panel_head(char line[PANEL_LINE], const struct session *session, uint64_t now_ns);

/* The statistics, a row each; rows that say nothing are empty. */
void panel_statistics(char row[PANEL_ROWS][PANEL_COLUMNS], const struct session *session);

/* What is there where one looks, and who else drives what. */
void panel_look(char line[PANEL_LINE], const struct session *session);
void panel_others(char line[PANEL_LINE], const struct session *session);

#endif
