/* An agent for the middleware SPADES, written from the description of its messages alone: it reads from descriptor 3
 * and writes to descriptor 4, each message behind a length of four bytes, big-endian.
 *
 *     agent TEAM [burn MS | hang N | crash N | garbage N | deaf N | quit N | last N | mute N | flood N | fork]
 *     agent tcp PORT [twice | flood | empty | mute | leave]
 *
 * The second form is an agent of the plain loop: it connects to PORT, sends (scene) and answers the n-th percepts with
 * (answer n), and (syn) in a message of its own. `twice` answers twice, `flood` sends without being asked, `empty` the
 * same without text, `mute` never sends anything, and `leave` does not connect.
 *
 * Like the agents of 2004 it counts sensations: it creates its sphere at the first, joins its team at the second, and
 * plays from the third on: it asks for the think time so far, requests a time notification, drives towards the ball and
 * kicks it. It prints and answers K. The second argument is how it misbehaves, from sensation N on, or how many ms of
 * CPU each thought takes. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include <arpa/inet.h>
#include <sys/socket.h>

static int in = 3, out = 4;
static char message[65536], bytes[65536];
static size_t kept = 0; /* of `bytes`: only a message X is kept */

static size_t need(size_t n) {
  while (kept < n) {
    ssize_t got = read(in, bytes + kept, sizeof bytes - kept);
    if (got <= 0) exit(1);
    kept += (size_t)got;
  }
  return n;
}

/* Agents of the time kept one message of what they read, and lost others without a word. This one ends then. */
static void receive(void) {
  const unsigned char* prefix = (const unsigned char*)bytes;
  need(4);
  size_t n = (size_t)prefix[0] << 24 | (size_t)prefix[1] << 16 | (size_t)prefix[2] << 8 | prefix[3];
  if (n + 4 > sizeof bytes) exit(1);
  size_t end = need(n + 4);
  memcpy(message, bytes + 4, n);
  message[n] = 0;
  kept -= end;
  memmove(bytes, bytes + end, kept);
  if (kept > 4 && bytes[4] != 'X') {
    fprintf(stderr, "two messages at once: %c and %c\n", message[0], bytes[4]);
    exit(1);
  }
}

static void sendText(const char* text) {
  size_t n = strlen(text);
  char bytes[1024] = {(char)(n >> 24), (char)(n >> 16), (char)(n >> 8), (char)n};
  memcpy(bytes + 4, text, n);
  if (write(out, bytes, n + 4) != (ssize_t)(n + 4)) exit(1);
}

static void burn(double ms) {
  struct timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  double end = t.tv_sec * 1e3 + t.tv_nsec * 1e-6 + ms;
  do clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  while (t.tv_sec * 1e3 + t.tv_nsec * 1e-6 < end);
}

/* Drives towards the ball, by the place at which the last sensation shows it, and kicks it when it is near. */
static void act(void) {
  const char* ball = strstr(message, "(Ball (pol ");
  double distance, angle, elevation;
  if (!ball) ball = strstr(message, "(B (pol ");
  if (!ball || sscanf(strchr(ball + 1, '('), "(pol %lf %lf %lf", &distance, &angle, &elevation) != 3) {
    sendText("A(drive 0 0 0)");
    return;
  }
  char text[128];
  snprintf(text, sizeof text, "A(drive %.2f %.2f 0)%s", 60 * cos(angle * M_PI / 180), 60 * sin(angle * M_PI / 180),
           distance < 0.4 ? "(kick 10 60)" : "");
  sendText(text);
}

static int playOverTcp(int port, const char* way) {
  struct sockaddr_in to = {.sin_family = AF_INET, .sin_port = htons((unsigned short)port)};
  if (strcmp(way, "leave") == 0) return 0;
  in = out = socket(AF_INET, SOCK_STREAM, 0);
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (connect(in, (struct sockaddr*)&to, sizeof to) != 0) return 1;
  if (strcmp(way, "mute") == 0)
    for (;;) pause();
  sendText("(scene)");
  while (strcmp(way, "flood") == 0) sendText("(more)");
  while (strcmp(way, "empty") == 0) sendText("");
  for (int n = 1;; ++n) {
    receive();
    for (int i = strcmp(way, "twice") == 0 ? 2 : 1; i > 0; --i) {
      char text[64];
      snprintf(text, sizeof text, "(answer %d)", n);
      sendText(text);
      sendText("(syn )");
    }
  }
}

int main(int argc, char** argv) {
  if (argc > 2 && strcmp(argv[1], "tcp") == 0) return playOverTcp(atoi(argv[2]), argc > 3 ? argv[3] : "");
  const char* team = argc > 1 ? argv[1] : "Spheres";
  const char* way = argc > 2 ? argv[2] : "";
  const int from = argc > 3 ? atoi(argv[3]) : 0;
  int sensations = 0;
  printf("%s plays\n", team);
  fflush(stdout);
  if (strcmp(way, "fork") == 0) {
    const int child = fork();
    if (child == 0)
      for (;;) pause();
    printf("child=%d\n", child);
    fflush(stdout);
  }
  for (;;) {
    receive();
    if (message[0] == 'D') sendText("I");
    if (message[0] == 'X') return 0;
    if (message[0] == 'K') {
      printf("%s\n", message);
      fflush(stdout);
      if (strcmp(way, "mute") != 0 || sensations < from) sendText("D");
    }
    if (message[0] == 'T') {
      sendText("A"); /* an empty act is legal */
      sendText("D");
    }
    if (message[0] != 'S') continue;
    const int n = ++sensations;
    if (from > 0 && n >= from) {
      if (strcmp(way, "hang") == 0) continue; /* no D */
      if (strcmp(way, "crash") == 0) abort();
      if (strcmp(way, "quit") == 0) return 0;
      while (strcmp(way, "flood") == 0) sendText("A(more)");
      if (strcmp(way, "garbage") == 0) {
        if (write(4, "\377\377\377\377 no length", 14) != 14) return 1;
        continue;
      }
      if (strcmp(way, "deaf") == 0) { /* reads no more */
        close(3);
        for (;;) pause();
      }
    }
    if (strcmp(way, "burn") == 0) burn(from);
    if (n == 1) {
      sendText("A(create)");
    } else if (n == 2) {
      char text[128];
      snprintf(text, sizeof text, "A(init (unum 0) (teamname %s))", team);
      sendText(text);
    } else {
      char text[65536];
      memcpy(text, message, sizeof text);
      sendText("C");
      receive(); /* its answer is next, by the protocol */
      if (message[0] != 'C') return 1;
      long sent, arrived;
      if (sscanf(text, "S%ld %ld", &sent, &arrived) == 2) {
        char request[64];
        snprintf(request, sizeof request, "R%ld", arrived + 5);
        sendText(request);
      }
      memcpy(message, text, sizeof text);
      act();
    }
    sendText("D");
    if (from > 0 && n >= from && strcmp(way, "last") == 0) return 0;
  }
}
