/* What the driver reads: the vehicle's statistics (thesis row 13) and what goes with them, as text.
 */
#ifndef JOLON_CLIENTS_DRIVE_STATUS_PANEL_H
#define JOLON_CLIENTS_DRIVE_STATUS_PANEL_H

#include "clients/drive/session.h"

#define STATUS_PANEL_ROWS    16
#define STATUS_PANEL_COLUMNS 36
#define STATUS_PANEL_LINE    512u

/* Everything in one line of key=value, as the table has it; for scripts. */
void status_panel_line(char line[STATUS_PANEL_LINE], const struct session *session);

/* Who, where, in which world: the line above all. */
void status_panel_head(char line[STATUS_PANEL_LINE], const struct session *session,
                       uint64_t now_ns);

/* The statistics, a row each; rows that say nothing are empty. */
void status_panel_statistics(char row[STATUS_PANEL_ROWS][STATUS_PANEL_COLUMNS],
                             const struct session *session);

/* What is there where one looks, and who else drives what. */
void status_panel_look(char line[STATUS_PANEL_LINE], const struct session *session);
void status_panel_others(char line[STATUS_PANEL_LINE], const struct session *session);

#endif
