/* The defaults of the settings of a gateway, as scenarios write them. The schema of scenarios and
 * the warning of settings without effect (gateway_idle.h) take them from here. */
#ifndef JOLON_WORLD_GATEWAY_DEFAULTS_H
#define JOLON_WORLD_GATEWAY_DEFAULTS_H

#define GATEWAY_DEFAULT_ADDRESS         "127.0.0.1"
#define GATEWAY_DEFAULT_PORT            "3000"
#define GATEWAY_DEFAULT_LISTEN          "none"
#define GATEWAY_DEFAULT_INTERFACE       "any"
#define GATEWAY_DEFAULT_EXERCISE        "1"
#define GATEWAY_DEFAULT_SITE            "1991"
#define GATEWAY_DEFAULT_APPLICATION     "1"
#define GATEWAY_DEFAULT_APPLICATIONS    "16"
#define GATEWAY_DEFAULT_VERSION         "7"
#define GATEWAY_DEFAULT_RATE            "5000"
#define GATEWAY_DEFAULT_CLAMP           "true"
#define GATEWAY_DEFAULT_TIMEOUT_S       "12"
#define GATEWAY_DEFAULT_UNDULATION_GRID "false"
#define GATEWAY_DEFAULT_COT             "none"
#define GATEWAY_DEFAULT_PEERS           "127.0.0.0/8, ::1"
#define GATEWAY_DEFAULT_CONTROL         "none"
#define GATEWAY_DEFAULT_REMOTES_MAX     "0"

#endif
