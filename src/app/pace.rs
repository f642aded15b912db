//! [`Pace`]: whether a run is played as fast as it is asked to be, and how many steps a repaint may do so that the
//! picture stays smooth.

/// How fast time passes in the run.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Pace {
    /// Simulated seconds a second, averaged over some time.
    rate: Option<f64>,
    /// Wall time that was counted, s.
    counted: f64,
    /// Said to be behind.
    behind: bool,
    /// What a step takes, s; unknown as long as nobody measures it.
    cost: Option<f64>,
    /// Steps of the last repaint.
    steps: f64,
}

/// Over how much wall time is averaged, s.
const AVERAGED: f64 = 0.5;
/// A repaint so late, s, says that the program was held up, not that it is slow.
const HELD_UP: f64 = 2.0;
/// What of the speed is slower than asked for, and what is as good as that again.
const SLOW: [f64; 2] = [0.9, 0.97];
/// What the steps of one repaint may take, s.
const BUDGET: f64 = 0.012;
/// The most steps of a repaint, while it is not known what they take and where they take next to nothing.
const MOST: [f64; 2] = [2000.0, 20_000.0];
/// What they are believed to have taken at most, s.
const LONGEST: f64 = 0.2;
/// Share of the newest measure in what a step takes.
const NEWEST: f64 = 0.3;

impl Pace {
    /// How many steps a repaint may do.
    pub fn most_steps(&self) -> f64 {
        self.cost.map_or(MOST[0], |cost| (BUDGET / cost.max(1e-9)).floor().clamp(1.0, MOST[1]))
    }

    /// In so much wall time so much time has passed in the run, s, in so many steps, where it was to be so many times as
    /// much.
    pub fn count(&mut self, wall: f64, simulated: f64, steps: f64, speed: f64) {
        self.steps = steps;
        if wall <= 0.0 || wall > HELD_UP {
            return;
        }
        let now = simulated / wall;
        let share = 1.0 - (-wall / AVERAGED).exp();
        let rate = self.rate.map_or(speed, |rate| rate) * (1.0 - share) + now * share;
        (self.rate, self.counted) = (Some(rate), self.counted + wall);
        let slow = if self.behind { SLOW[1] } else { SLOW[0] };
        self.behind = self.counted >= AVERAGED && rate < slow * speed;
    }

    /// What the steps of the last repaint have taken, s.
    pub fn took(&mut self, seconds: f64) {
        if self.steps >= 1.0 {
            // A program that was held up has learnt nothing of its steps.
            let now = seconds.min(LONGEST) / self.steps;
            self.cost = Some(self.cost.map_or(now, |cost| cost + NEWEST * (now - cost)));
        }
    }

    /// Time stands.
    pub fn rest(&mut self) {
        *self = Self { cost: self.cost, ..Self::default() };
    }

    /// Simulated seconds a second, where that is less than asked for.
    pub fn behind(&self) -> Option<f64> {
        self.rate.filter(|_| self.behind)
    }
}
