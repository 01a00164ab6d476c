/* Text for the driver: the vehicle's statistics (thesis row 13), the view ahead, other drivers. */
#ifndef JOLON_CLIENTS_DRIVE_STATUS_PANEL_H
#define JOLON_CLIENTS_DRIVE_STATUS_PANEL_H

#include "clients/drive/session.h"

#define STATUS_PANEL_ROWS    16
#define STATUS_PANEL_COLUMNS 36
#define STATUS_PANEL_LINE    512u

/* All statistics in one line of key=value, for scripts. */
void status_panel_line(char line[STATUS_PANEL_LINE], const struct session *session);

/* The title: the vehicle, the world, the frame. */
void status_panel_head(char line[STATUS_PANEL_LINE], const struct session *session,
                       uint64_t now_ns);

/* The statistics, one a row; rows that do not apply are empty. */
void status_panel_statistics(char row[STATUS_PANEL_ROWS][STATUS_PANEL_COLUMNS],
                             const struct session *session);

/* The entity ahead in the direction of view; the vehicles of other drivers. */
void status_panel_look(char line[STATUS_PANEL_LINE], const struct session *session);
void status_panel_others(char line[STATUS_PANEL_LINE], const struct session *session);

#endif
