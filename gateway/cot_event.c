/* Events of Cursor on Target. The attributes are those of MITRE's schema of 2.0; a deletion is what
 * ATAK takes for one: type t-x-d-d, a link to the thing and __forcedelete. */
#include "gateway/cot_event.h"

#include <stdarg.h>
#include <stdio.h>

#define DELETION   "t-x-d-d"
#define MS_PER_DAY 86400000

/* A text that grows; at stays within size, and full says that something had no room. */
struct xml {
    char *text;
    size_t size, at;
    bool full;
};

__attribute__((format(printf, 2, 3))) static void put(struct xml *xml, const char *format, ...)
{
    va_list values;
    size_t left = xml->size - xml->at;
    va_start(values, format);
    int length = vsnprintf(xml->text + xml->at, left, format, values);
    va_end(values);
    if (length < 0 || (size_t)length >= left)
        xml->full = true;
    else
        xml->at += (size_t)length;
}

/* Puts the value of an attribute between its quotes. */
static void put_escaped(struct xml *xml, const char *value)
{
    for (; *value != '\0'; value++) {
        switch (*value) {
        case '&':
            put(xml, "&amp;");
            break;
        case '<':
            put(xml, "&lt;");
            break;
        case '>':
            put(xml, "&gt;");
            break;
        case '"':
            put(xml, "&quot;");
            break;
        case '\'':
            put(xml, "&apos;");
            break;
        default:
            put(xml, "%c", *value >= ' ' && *value <= '~' ? *value : '?');
        }
    }
}

static void put_attribute(struct xml *xml, const char *name, const char *value)
{
    put(xml, " %s=\"", name);
    put_escaped(xml, value);
    put(xml, "\"");
}

/* Puts a time as ISO 8601. The C library's gmtime() may read the file of the time zone, which a
 * sandbox forbids. A year begins in March here, so that the leap day is its last; the 400 years of
 * the calendar's cycle have 146097 days. */
static void put_time(struct xml *xml, const char *name, int64_t time_ms)
{
    int64_t day = time_ms / MS_PER_DAY + 719468; /* since 0000-03-01 */
    int64_t ms = time_ms % MS_PER_DAY;
    int64_t cycle = day / 146097, in_cycle = day % 146097;
    int64_t year = (in_cycle - in_cycle / 1460 + in_cycle / 36524 - in_cycle / 146096) / 365;
    int64_t in_year = in_cycle - (365 * year + year / 4 - year / 100);
    int64_t month = (5 * in_year + 2) / 153; /* 0: March */
    int64_t in_month = in_year - (153 * month + 2) / 5;
    put(xml, " %s=\"%04d-%02d-%02dT%02d:%02d:%02d.%03dZ\"", name,
        (int)(year + 400 * cycle + (month >= 10)), (int)(month < 10 ? month + 3 : month - 9),
        (int)in_month + 1, (int)(ms / 3600000), (int)(ms / 60000 % 60), (int)(ms / 1000 % 60),
        (int)(ms % 1000));
}

/* Puts what both events have: all up to the details. opex says that this is a simulation. */
static void put_head(struct xml *xml, const struct cot_event *event, const char *type)
{
    put(xml,
        "<?xml version=\"1.0\" encoding=\"UTF-8\" standalone=\"yes\"?>\n<event version=\"2.0\"");
    put_attribute(xml, "uid", event->uid);
    put_attribute(xml, "type", type);
    put_time(xml, "time", event->time_ms);
    put_time(xml, "start", event->time_ms);
    put_time(xml, "stale", event->stale_ms);
    put(xml,
        " how=\"m-g\" opex=\"s\"><point lat=\"%.7f\" lon=\"%.7f\" hae=\"%.2f\" ce=\"%.1f\" "
        "le=\"%.1f\"/><detail>",
        event->latitude_deg, event->longitude_deg, event->height_m, event->error_m, event->error_m);
}

static size_t finish(struct xml *xml)
{
    put(xml, "</detail></event>\n");
    return xml->full ? 0 : xml->at;
}

size_t cot_event_write(const struct cot_event *event, char *text, size_t size)
{
    struct xml xml = {.text = text, .size = size};
    put_head(&xml, event, event->type);
    put(&xml, "<contact");
    put_attribute(&xml, "callsign", event->callsign);
    put(&xml, "/><track course=\"%.2f\" speed=\"%.2f\"/>", event->course_deg, event->speed_mps);
    return finish(&xml);
}

size_t cot_event_write_deletion(const struct cot_event *event, char *text, size_t size)
{
    struct xml xml = {.text = text, .size = size};
    put_head(&xml, event, DELETION);
    put(&xml, "<link");
    put_attribute(&xml, "uid", event->uid);
    put(&xml, " relation=\"none\"");
    put_attribute(&xml, "type", event->type);
    put(&xml, "/><__forcedelete/>");
    return finish(&xml);
}
