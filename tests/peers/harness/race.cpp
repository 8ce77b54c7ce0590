// Races competitors on the same rays, in turns.
//
//  race rays  MESH PREFIX COMPETITOR                        writes PREFIX.SET.rays; the competitor finds the primary hits
//  race trace MESH RAYS SET THREADS ROUNDS COMPETITOR...    a line a competitor and number of threads, see `trace`
//                                                           THREADS is a number or several with commas between them
//  race build MESH THREADS COMPETITOR                       one build, alone in its process: a line, see `build`
//
// A competitor is LIBRARY.so:VARIANT.
#include "make_rays.hpp"
#include <atomic>
#include <chrono>
#include <functional>
#include <malloc.h>
#include <thread>
#include <xmmintrin.h>

static double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// As Embree recommends to its callers: flush-to-zero and denormals-are-zero.
static void flush_subnormals() { _mm_setcsr(_mm_getcsr() | 0x8040); }

// Rays in a call.
constexpr size_t CALL = 8192;
// Rays in a turn: short enough that a slow moment of the machine falls on few of them.
constexpr size_t TURN = 262144;
// Rounds for a competitor that needs more than a second for all rays.
constexpr size_t SLOW_ROUNDS = 3;

// Seconds that `threads` threads take to call `work(first, count)` for all of n rays. Making threads is not timed.
static double seconds(int threads, size_t n, const std::function<void(size_t, size_t)> &work) {
  std::atomic<size_t> next{0};
  std::atomic<int> waiting{0};
  std::atomic<bool> go{false};
  auto run = [&] {
    flush_subnormals();
    for (size_t first; (first = next.fetch_add(CALL)) < n;) work(first, std::min(CALL, n - first));
  };
  std::vector<std::thread> others;
  for (int k = 1; k < threads; k++)
    others.emplace_back([&] {
      waiting++;
      while (!go) {
      }
      run();
    });
  while (waiting < threads - 1) {
  }
  const double start = now();
  go = true;
  run();
  for (auto &thread : others) thread.join();
  return now() - start;
}

// The answers to one set of rays.
struct Answers {
  std::vector<PeerHit> hits;
  std::vector<uint8_t> occluded;

  Answers(size_t n, bool any) : hits(any ? 0 : n), occluded(any ? n : 0) {}

  bool is_hit(size_t k) const { return hits.empty() ? occluded[k] : hits[k].prim != UINT32_MAX; }

  // Another answer: hit for miss, or a t that is off by more than f32 arithmetic explains.
  bool differs(const Answers &other, size_t k) const {
    if (is_hit(k) != other.is_hit(k)) return true;
    if (hits.empty() || !is_hit(k)) return false;
    const float t = hits[k].t, reference = other.hits[k].t;
    return !(std::fabs(t - reference) <= 1e-4f * (std::fabs(reference) + 1e-3f));
  }
};

// A competitor on a number of threads.
struct Entry {
  Competitor *competitor;
  int threads;
  size_t hits = 0, differing = 0, rounds = 0;
  std::vector<std::vector<double>> times; // by round and turn
};

// Prints for each competitor and number of threads: name, threads, rays, hits, rays whose answer differs from the first competitor's,
// seconds of the fastest turns together, and the seconds of each round.
static void trace(const Mesh &mesh, const RaySet &rays, bool any, const std::vector<int> &threads, size_t rounds,
                  std::vector<Competitor> &competitors) {
  const size_t n = rays.rays.size(), turns = (n + TURN - 1) / TURN;
  Answers answers(n, any), reference(n, any);
  auto turn = [&](const Entry &entry, size_t from, size_t count) {
    return seconds(entry.threads, count, [&](size_t first, size_t m) {
      const size_t at = from + first;
      if (any) entry.competitor->any(rays, at, m, &answers.occluded[at]);
      else entry.competitor->closest(rays, at, m, &answers.hits[at]);
    });
  };

  // Answers, and with them a first touch of all memory.
  std::vector<Entry> entries;
  for (auto &competitor : competitors) competitor.build(mesh, *std::max_element(threads.begin(), threads.end()));
  for (int count : threads)
    for (auto &competitor : competitors) {
      Entry entry{&competitor, count};
      const double once = turn(entry, 0, n);
      entry.rounds = once > 1.0 ? std::min(rounds, SLOW_ROUNDS) : rounds;
      if (entries.empty()) reference = answers;
      for (size_t k = 0; k < n; k++) {
        entry.hits += answers.is_hit(k);
        entry.differing += answers.differs(reference, k);
      }
      entries.push_back(entry);
    }

  for (size_t round = 0; round < rounds; round++) {
    for (auto &entry : entries) entry.times.emplace_back();
    for (size_t t = 0; t < turns; t++)
      for (size_t k = 0; k < entries.size(); k++) {
        // Whoever begins moves on.
        Entry &entry = entries[(k + round + t) % entries.size()];
        if (round < entry.rounds) entry.times[round].push_back(turn(entry, t * TURN, std::min(TURN, n - t * TURN)));
      }
  }

  for (const Entry &entry : entries) {
    double best = 0;
    for (size_t t = 0; t < turns; t++) {
      double least = INFINITY;
      for (size_t round = 0; round < entry.rounds; round++) least = std::min(least, entry.times[round][t]);
      best += least;
    }
    printf("%s %d %zu %zu %zu %.9f", entry.competitor->name().c_str(), entry.threads, n, entry.hits, entry.differing, best);
    for (size_t round = 0; round < entry.rounds; round++) {
      double sum = 0;
      for (double time : entry.times[round]) sum += time;
      printf(" %.9f", sum);
    }
    printf("\n");
  }
  for (auto &competitor : competitors) competitor.release();
}

// The numbers of a list with commas.
static std::vector<int> numbers(const std::string &list) {
  std::vector<int> found;
  for (size_t at = 0; at < list.size(); at = list.find(',', at) == list.npos ? list.size() : list.find(',', at) + 1)
    found.push_back(std::max(std::atoi(list.c_str() + at), 1));
  if (found.empty()) fail("no number of threads");
  return found;
}

// Bytes of memory in use, and the most that there ever were, from the line of /proc/self/status called `name`.
static double memory(const char *name) {
  FILE *file = fopen("/proc/self/status", "r");
  char line[256];
  long kilobytes = 0;
  while (file && fgets(line, sizeof line, file))
    if (!strncmp(line, name, strlen(name))) kilobytes = atol(line + strlen(name) + 1);
  if (file) fclose(file);
  return kilobytes * 1024.0;
}

// Prints name, seconds, bytes as the competitor counts them, growth of resident memory, and its peak while building.
static void build(const Mesh &mesh, int threads, Competitor &competitor) {
  const double before = memory("VmRSS"), start = now();
  competitor.build(mesh, threads);
  const double time = now() - start;
  malloc_trim(0);
  printf("%s %.6f %zu %.0f %.0f\n", competitor.name().c_str(), time, competitor.bytes(), memory("VmRSS") - before,
         memory("VmHWM") - before);
}

int main(int count, char **words) {
  const std::vector<std::string> argument(words + 1, words + count);
  flush_subnormals();
  if (argument.size() == 4 && argument[0] == "rays") {
    Competitor guide(argument[3]);
    make_rays(read_mesh(argument[1]), argument[2], guide);
  } else if (argument.size() >= 7 && argument[0] == "trace") {
    std::vector<Competitor> competitors(argument.begin() + 6, argument.end());
    const Mesh mesh = read_mesh(argument[1]);
    const bool any = argument[3] == "shadow" || argument[3] == "frame-shadow";
    trace(mesh, read_rays(argument[2], LIFT * Viewpoint(mesh).diagonal), any, numbers(argument[4]), std::stoul(argument[5]), competitors);
  } else if (argument.size() == 4 && argument[0] == "build") {
    Competitor competitor(argument[3]);
    build(read_mesh(argument[1]), std::stoi(argument[2]), competitor);
  } else {
    fail("see the head of race.cpp for its arguments");
  }
}
