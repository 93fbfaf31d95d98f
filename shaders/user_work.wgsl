// Bounds the work of loops in functions of the user's own. The module declares the buffer `report`.

// What is known of a run of all passes that call them.
struct UserReport {
    // The work of all loops, in pieces.
    work: atomic<u32>,
    // 1 if there was too much, so that no result counts.
    stopped: atomic<u32>,
    // Results that are replaced or ignored, because they aren't numbers.
    not_numbers: atomic<u32>,
}

// Work is counted in tokens of the user's text that loops go through, and reported in pieces of so many.
const WORK_PIECE: u32 = 4096u;
// The most pieces of one invocation, which are four million tokens, and of all invocations together.
const MOST_WORK: u32 = 1024u;
const MOST_WORK_OF_ALL: u32 = 0x400000u;

var<private> work_since_report: u32;
var<private> work_reported: u32;
var<private> is_stopped: bool;

// Starts a run.
fn clear_report() {
    atomicStore(&report.work, 0u);
    atomicStore(&report.stopped, 0u);
    atomicStore(&report.not_numbers, 0u);
}

// Whether there was too much work in this run.
fn has_stopped() -> bool {
    return atomicLoad(&report.stopped) != 0u;
}

// Counts the work of a turn of a loop. Returns true if the function must return, because there was too much. Which invocations are
// stopped then depends on their order, but not whether any is: so the last pass of a run replaces the results of all.
fn spend(work: u32) -> bool {
    work_since_report += work;
    if !is_stopped && work_since_report >= WORK_PIECE {
        let pieces = work_since_report / WORK_PIECE;
        work_since_report = work_since_report % WORK_PIECE;
        work_reported += pieces;
        let of_all = atomicAdd(&report.work, pieces) + pieces;
        if work_reported > MOST_WORK || of_all > MOST_WORK_OF_ALL {
            atomicStore(&report.stopped, 1u);
        }
        is_stopped = has_stopped();
    }
    return is_stopped;
}
