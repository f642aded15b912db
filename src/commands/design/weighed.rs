//! `stillbase design --counterweights`

use std::fmt::Display;
use std::time::Instant;

use clap::Args;
use stillbase_exchange::thin::thin_wall;
use stillbase_mechanics::counterweights::{
    BoundRelaxation, CounterweightError, CounterweightForm, CounterweightSpec, CounterweightStock, FreeRotor,
    Objective, RotorFreedom,
};
use stillbase_mechanics::machine::{BarStock, Counterweight, CounterweightShape, Machine};
use stillbase_planning::Motion;
use stillbase_session::scenario::{DesignBrief, NameSet};
use stillbase_settings::number::{counted, fixed, fixed_or_finer, nine_digits, significant};
use stillbase_study::counterweights::{
    CounterweightReport, CounterweightRequest, LengthsReport, NoCounterweights, balance_by_weights, removed_weights,
};
use stillbase_study::front_point::FrontPoint;
use stillbase_study::lengths::{FreeLength, LengthSearch, NoLengths};
use stillbase_study::measures::greatest_accelerations;
use stillbase_study::workshop::{CutRequest, NoCut};

use super::super::check::balance_tables;
use super::super::dimensions::density;
use super::super::ends::parse_bounds;
use super::super::exit::print_message;
use super::super::failure::Failure;
use super::super::output::TextTable;
use super::super::progress::goes_on;
use super::super::sites::{Names, range};
use super::measures;

/// Constraints on the counterweights, and the objective to minimise.
#[derive(Args, Clone)]
pub struct WeightArguments {
    /// Balance the machine by counterweights, discs on the links; existing ones are removed first unless
    /// they have fixed = true
    #[arg(long, conflicts_with_all = ["penalty", "preset", "keep"])]
    pub counterweights: bool,
    /// A link that may carry a counterweight, and the bounds of its place, m from the root towards the tip. Default:
    /// every link, from one link length behind the root to the tip
    #[arg(long, value_name = "LINK=LO,HI", requires = "counterweights", value_parser = range, allow_hyphen_values = true)]
    range: Vec<(String, [f64; 2])>,
    /// Maximum distance of a counterweight from the axis of its link, to either side, m; by default it lies on the axis
    #[arg(long, value_parser = number, value_name = "METRES", requires = "counterweights")]
    across: Option<f64>,
    /// Shape of the counterweights: disc; ring,A or half-ring,A with an inner radius, m; box,W with a width across the
    /// link, m, as long as its mass takes. Half a ring has its round side away from the root of its link. Default: disc
    #[arg(long, value_parser = shape, value_name = "disc|ring,A|half-ring,A|box,W", requires = "counterweights")]
    shape: Option<CounterweightForm>,
    /// Material of the counterweights: aluminium, steel, brass, lead, tungsten, or a density, kg/m³; default: steel
    #[arg(long, value_parser = density, value_name = "MATERIAL", requires = "counterweights")]
    pub material: Option<f64>,
    /// Thickness of the counterweights, m; default: 0.03
    #[arg(long, value_parser = number, value_name = "T", requires = "counterweights")]
    pub thickness: Option<f64>,
    /// Maximum mass of a counterweight, kg: M for every link, or LINK=M for one
    #[arg(long, value_name = "[LINK=]M", requires = "counterweights")]
    max_mass: Vec<String>,
    /// Maximum outer radius of a disc, a ring or half a ring, m
    #[arg(long, value_parser = number, value_name = "R", requires = "counterweights")]
    max_radius: Option<f64>,
    /// Minimum distance from the edge of a counterweight to the centre of every pin of its link, m; by default it may
    /// cover pins. Half a ring and a box count as the rectangle around them. A pin may lie in the bore of a ring, and on
    /// the axis also in that of half a ring
    #[arg(long, value_parser = number, value_name = "C", requires = "counterweights")]
    clearance: Option<f64>,
    /// Minimum and maximum payload, kg. First the largest residual over this range is minimised, then the objective.
    /// Residuals are |g_k| of Eq (7), and |C_kl| of Eq (8) divided by the reach
    #[arg(long, value_name = "LO,HI", requires = "counterweights", value_parser = payload)]
    payload: Option<[f64; 2]>,
    /// Optimise the inertia of a drive's rotor within these bounds, kg m²; its ratio stays unchanged
    #[arg(long, value_name = "DRIVE=LO,HI", requires = "counterweights", value_parser = range)]
    rotor_inertia: Vec<(String, [f64; 2])>,
    /// Optimise the ratio of a drive's rotor within these bounds, negative to counter-rotate; its inertia stays
    /// unchanged
    #[arg(long, value_name = "DRIVE=LO,HI", requires = "counterweights", value_parser = range, allow_hyphen_values = true)]
    rotor_ratio: Vec<(String, [f64; 2])>,
    /// Objective to minimise: mass, inertia, momentum, torque, or a weighted sum as mass=1,inertia=5. The mass is the
    /// added mass; the inertia is Σ H_kk, without gears equal to Σ D_k. The momentum is that given to the base,
    /// Σ |D_k|; counter-rotating rotors reduce it. The torque is the maximum |τ| during --task, whereas the β of torque
    /// is a ratio of root mean squares
    #[arg(long, value_name = "mass|inertia|momentum|torque|WEIGHTS", requires = "counterweights", value_parser = objective)]
    objective: Option<Objective>,
    /// Maximum total mass of the counterweights, kg
    #[arg(long, value_parser = number, value_name = "M", requires = "counterweights")]
    max_added: Option<f64>,
    /// Maximum Σ D_k, kg m²
    #[arg(long, value_parser = number, value_name = "D", requires = "counterweights")]
    max_inertia: Option<f64>,
    /// Optimise a length within these bounds, m: a name under [lengths] or a link. Links keep their mass per metre. The
    /// lengths are the best of several searches, not certified; the counterweights for these lengths are certified
    #[arg(long, value_name = "NAME=LO,HI", requires = "counterweights", value_parser = range)]
    length: Vec<(String, [f64; 2])>,
    /// Minimum reach, the sum of the lengths of all arms, m
    #[arg(long, value_parser = number, value_name = "R", requires = "length")]
    min_reach: Option<f64>,
    /// Minimum area of the reactionless workspace, m²
    #[arg(long, value_parser = number, value_name = "A", requires = "length")]
    min_workspace: Option<f64>,
    /// Number of starting points of the search for lengths
    #[arg(long, value_name = "N", requires = "length", default_value_t = 6, value_parser = clap::value_parser!(u16).range(1..=1000))]
    starts: u16,
    /// Seed of the random starting points: the same seed finds the same lengths
    #[arg(long, value_name = "S", requires = "length", default_value_t = 1)]
    seed: u64,
    /// Stop the search for lengths after this time, s, and use the best lengths so far
    #[arg(long, value_name = "S", requires = "length", value_parser = number)]
    seconds: Option<f64>,
    /// Show the Pareto front of mass and inertia as N machines, from minimum mass to minimum inertia. Each row also
    /// gives torque (with --task), workspace, the maximum |g_k| if masses are 1 % and places 0.5 mm off, and how far its
    /// mass or Σ D_k may lie above the minimum
    #[arg(long, value_name = "N", requires = "counterweights", value_parser = clap::value_parser!(u16).range(2..=1000))]
    front: Option<u16>,
    /// Balance each block of an assembly in its plane alone, Eqs (7) and (8). It may then tilt the base, as links at
    /// different heights do, and what it carries may lie beside its end effector. Otherwise it does neither where any
    /// counterweights prevent it, at the price that the answer tells
    #[arg(long, requires = "counterweights")]
    pub in_plane: bool,
    /// Cut the links from flat bars of this width and thickness, m, of a material; default: aluminium. Tails, arms and
    /// holes are weighed, and the design repeated until bars and discs agree. A link with parts keeps them. A front is
    /// that of counterweights on these bars
    #[arg(long, value_name = "WIDTH,THICKNESS[,MATERIAL]", requires = "counterweights", value_parser = bars, conflicts_with = "length")]
    bars: Option<BarStock>,
    /// Diameter of the hole for each pin of these bars, m; default: 0.008
    #[arg(long, value_name = "D", requires = "bars", value_parser = number)]
    pin_diameter: Option<f64>,
    /// Take discs as they are bought, with radii and places in steps of 0.1 mm; the answer says what is left of Eqs (7)
    /// and (8), and which bounds the rounded discs break. Nothing is certified of them
    #[arg(long, requires = "bars")]
    bought: bool,
}

/// Options that a study of many designs may vary, without `--`: a word each.
pub const VARIED_OPTIONS: [&str; 9] =
    ["material", "thickness", "across", "clearance", "max-mass", "max-radius", "max-added", "max-inertia", "objective"];

impl WeightArguments {
    /// Returns the key of a brief, without `design.`, that one of [`VARIED_OPTIONS`] overrules.
    pub fn key_of(option: &str) -> Option<&'static str> {
        match option {
            "material" => Some("density"),
            "thickness" => Some("thickness"),
            "across" => Some("across"),
            "clearance" => Some("clearance"),
            "max-mass" => Some("heaviest"),
            _ => None,
        }
    }

    /// Returns whether one of [`VARIED_OPTIONS`] is given.
    pub fn gives(&self, option: &str) -> bool {
        match option {
            "max-mass" => !self.max_mass.is_empty(),
            "objective" => self.objective.is_some(),
            option => self.clone().number_of(option).is_some_and(|number| number.is_some()),
        }
    }

    /// Gives one of [`VARIED_OPTIONS`], as the command line does.
    ///
    /// # Errors
    /// If the word is no value of the option.
    pub fn give(&mut self, option: &str, word: &str) -> Result<(), String> {
        match option {
            "max-mass" => self.max_mass.push(number(word)?.to_string()),
            "objective" if word.contains('=') => {
                return Err("want mass, inertia, momentum or torque: a weighted sum cannot vary".into());
            }
            "objective" => self.objective = Some(objective(word)?),
            option => {
                let value = if option == "material" { density(word)? } else { number(word)? };
                if let Some(own) = self.number_of(option) {
                    *own = Some(value);
                }
            }
        }
        Ok(())
    }

    /// Returns the number of one of [`VARIED_OPTIONS`].
    fn number_of(&mut self, option: &str) -> Option<&mut Option<f64>> {
        match option {
            "material" => Some(&mut self.material),
            "thickness" => Some(&mut self.thickness),
            "across" => Some(&mut self.across),
            "clearance" => Some(&mut self.clearance),
            "max-radius" => Some(&mut self.max_radius),
            "max-added" => Some(&mut self.max_added),
            "max-inertia" => Some(&mut self.max_inertia),
            _ => None,
        }
    }

    /// Returns the brief of a machine's file, overruled by the arguments.
    pub fn brief(&self, machine: &Machine, own: &DesignBrief) -> DesignBrief {
        let mut brief = own.clone();
        brief.density = self.material.unwrap_or(own.density);
        brief.thickness = self.thickness.unwrap_or(own.thickness);
        brief.across = self.across.unwrap_or(own.across);
        brief.clearance = self.clearance.or(own.clearance);
        brief.payload = self.payload.or(own.payload);
        brief.reach = self.min_reach.or(own.reach);
        brief.workspace = self.min_workspace.or(own.workspace);
        brief.length.extend(self.length.iter().cloned());
        brief.ratio.extend(self.rotor_ratio.iter().cloned());
        if let Some(form) = self.shape {
            brief.shape = form.kind();
            match form {
                CounterweightForm::Disc => {}
                CounterweightForm::Ring(inner) | CounterweightForm::HalfRing(inner) => brief.inner_radius = inner,
                CounterweightForm::Box(width) => brief.box_width = width,
            }
        }
        // A word that is no mass is refused with the problem.
        let heaviest = self.max_mass.iter().filter_map(|word| word.trim().parse().ok()).reduce(f64::min);
        brief.heaviest = heaviest.or(own.heaviest);
        // Ranges say where counterweights lie, and bars go with lengths as they are.
        if !self.range.is_empty() {
            (brief.behind_root, brief.fixed) = (None, NameSet::default());
        }
        if !self.length.is_empty() {
            brief.as_cut = false;
        }
        if let Some(BarStock { width, thickness, material, .. }) = &self.bars {
            brief.as_cut = true;
            (brief.bar_width, brief.bar_thickness) = (*width, *thickness);
            brief.bar_density = machine.spec().density_of(material).unwrap_or(own.bar_density);
            brief.pin_diameter = self.pin_diameter.unwrap_or(BarStock::default().pin_diameter);
        }
        brief
    }

    /// Returns whether a key of a brief, without `design.`, matters to counterweights.
    pub fn asks_for(&self, key: &str) -> bool {
        match key.split_once('.').map_or(key, |(head, _)| head) {
            "keep_balanced" | "penalties" | "hold" => false,
            "length" | "reach" | "workspace" => !self.length.is_empty(),
            "ratio" => self.takes_ratios(),
            _ => true,
        }
    }

    /// Returns whether the ratios of the brief are chosen.
    fn takes_ratios(&self) -> bool {
        let of_momentum = self.objective.as_ref().is_some_and(|objective| objective.momentum > 0.0);
        !self.rotor_ratio.is_empty() || (of_momentum && self.rotor_inertia.is_empty())
    }

    /// Returns the problem that the arguments and the brief define for a machine.
    pub fn spec(
        &self,
        machine: &Machine,
        brief: &DesignBrief,
        motion: Option<&Motion>,
    ) -> Result<CounterweightSpec, Failure> {
        let accelerations = motion.map(|motion| greatest_accelerations(motion).to_vec());
        self.spec_of(&Names::from(machine), brief.lightest_problem(machine), brief, accelerations)
    }

    /// Returns the problem that the arguments define for named links and drives. `asked` is that of the brief;
    /// `accelerations` are the greatest of each drive in a motion, rad/s².
    pub fn spec_of(
        &self,
        names: &Names,
        asked: CounterweightSpec,
        brief: &DesignBrief,
        accelerations: Option<Vec<f64>>,
    ) -> Result<CounterweightSpec, Failure> {
        let mut sites = match self.range.is_empty() {
            true => asked.sites,
            false => names.sites(&self.range, brief.across)?,
        };
        let mut heaviest = vec![f64::INFINITY; names.links()];
        for word in &self.max_mass {
            let (name, most) = word.split_once('=').map_or((None, word.as_str()), |(name, most)| (Some(name), most));
            let want = || Failure::wrong_input(format!("--max-mass {word}: want a mass above 0 in kg, or LINK=M"));
            let most: f64 = most.trim().parse().ok().filter(|most| *most > 0.0).ok_or_else(want)?;
            let only = name.map(|name| names.link(name.trim())).transpose()?;
            let of = heaviest.iter_mut().enumerate().filter(|(link, _)| only.is_none_or(|only| only == *link));
            of.for_each(|(_, heaviest)| *heaviest = heaviest.min(most));
        }
        for site in &mut sites {
            // What the arguments say of one link overrules what the brief says of all.
            let most = Some(heaviest[site.link]).filter(|most| most.is_finite());
            site.most = most.or(brief.heaviest).unwrap_or(f64::INFINITY);
        }
        let stock = asked.stock;
        if let Some(radius) = self.max_radius {
            if !(radius.is_finite() && radius > 0.0) {
                return Err(Failure::wrong_input(format!("--max-radius {radius}: want a radius above 0 in m")));
            }
            let Some(most) = stock.mass_of_radius(radius) else {
                let want = match stock.form {
                    CounterweightForm::Box(_) => "a box has no radius: want --max-mass".to_owned(),
                    _ => format!("want more than the inner radius, {} m", nine_digits(stock.inner_radius())),
                };
                return Err(Failure::wrong_input(format!("--max-radius {radius}: {want}")));
            };
            sites.iter_mut().for_each(|site| site.most = site.most.min(most));
        }
        let mut objective = self.objective.clone().unwrap_or_else(Objective::mass);
        match accelerations {
            Some(accelerations) => objective.accelerations = accelerations,
            None if objective.torque > 0.0 => {
                let why =
                    "--objective torque: the torque depends on the motion: want --task SCENARIO, as --task case-3";
                return Err(Failure::wrong_input(why));
            }
            None => {}
        }
        Ok(CounterweightSpec {
            max_added_mass: self.max_added,
            max_inertia: self.max_inertia,
            clearance: brief.clearance,
            rotors: self.rotors(names, brief)?,
            payload: brief.payload,
            ..CounterweightSpec::least(objective, sites, stock)
        })
    }

    /// Returns whether a Pareto front is asked for.
    pub fn has_front(&self) -> bool {
        self.front.is_some()
    }

    /// Returns the number of machines of a Pareto front; two by default.
    pub fn front_count(&self) -> usize {
        self.front.map_or(2, usize::from)
    }

    /// Returns the bars of which links are cut, if they are, and a machine that knows their material.
    ///
    /// # Errors
    /// If the machine is not valid with one more material.
    pub fn bars(&self, machine: &Machine, brief: &DesignBrief) -> Result<(Machine, Option<CutRequest>), Failure> {
        let (machine, stock) = match &self.bars {
            Some(stock) => {
                let pin_diameter = self.pin_diameter.unwrap_or(stock.pin_diameter);
                (machine.clone(), BarStock { pin_diameter, ..stock.clone() })
            }
            None if brief.as_cut => brief.stock(machine)?,
            None => return Ok((machine.clone(), None)),
        };
        Ok((machine, Some(CutRequest { stock, bought: self.bought })))
    }

    fn rotors(&self, names: &Names, brief: &DesignBrief) -> Result<Vec<FreeRotor>, Failure> {
        let inertia = self.rotor_inertia.iter().map(|(name, ends)| (name, RotorFreedom::Inertia(*ends)));
        let ratios = if self.rotor_ratio.is_empty() && self.takes_ratios() {
            brief.ratio.iter().map(|(name, ends)| (name, *ends)).collect()
        } else {
            self.rotor_ratio.iter().map(|(name, ends)| (name, *ends)).collect::<Vec<_>>()
        };
        let ratio = ratios.into_iter().map(|(name, ends)| (name, RotorFreedom::Ratio(ends)));
        inertia.chain(ratio).map(|(name, parameter)| Ok(FreeRotor { drive: names.drive(name)?, parameter })).collect()
    }

    /// Returns the options given that are for one machine by itself, each with what an assembly takes instead.
    pub fn of_one_machine(&self) -> Option<[&'static str; 2]> {
        const LENGTHS: &str = "lengths as they are, or design --counterweights --length of one machine";
        const BARS: &str = "links as they are, or design --counterweights --bars of one machine";
        [
            (self.payload.is_some(), ["--payload", "payload.mass of a block, as --set BLOCK.payload.mass=0.2"]),
            (!self.length.is_empty(), ["--length", LENGTHS]),
            (self.bars.is_some(), ["--bars", BARS]),
        ]
        .into_iter()
        .find_map(|(given, words)| given.then_some(words))
    }

    /// Converts the reason why there are no counterweights into a failure, in the words `said`. If radii are bounded,
    /// feasible masses are also given as radii.
    fn refusal(&self, said: &dyn Display, why: &CounterweightError, stock: &CounterweightStock) -> Failure {
        let (CounterweightError::Conflict { reliefs, .. } | CounterweightError::Reaches { reliefs, .. }, Some(_)) =
            (why, self.max_radius)
        else {
            return if is_wrong_input(why) { Failure::wrong_input(said) } else { Failure::no_answer(said) };
        };
        let mut said = said.to_string();
        for relief in reliefs.iter().flatten() {
            if let BoundRelaxation::Most(most) = relief {
                let (_, radius) = Counterweight::new("", *most, [0.0; 2], stock.shape(*most)).free_size();
                let radius = (radius * 1e6 * (1.0 + 1e-9)).ceil() * 1e-6;
                said.push_str(&format!("; {most:.6} kg takes a radius of {radius:.6} m"));
            }
        }
        Failure::no_answer(said)
    }

    /// Returns the search for lengths, if lengths are free.
    fn lengths(&self, brief: &DesignBrief, weighing: &CounterweightSpec) -> Option<LengthSearch> {
        let lengths = self.length.iter().map(|(name, ends)| FreeLength { name: name.clone(), bounds: *ends });
        (!self.length.is_empty()).then(|| LengthSearch {
            lengths: lengths.collect(),
            spec: weighing.clone(),
            anywhere: self.range.is_empty(),
            least_reach: brief.reach,
            least_workspace: brief.workspace,
            starts: self.starts.into(),
            seed: self.seed,
        })
    }

    /// Finds the counterweights within a brief. Returns the machine that carries them, and the report on it.
    pub fn run(
        &self,
        machine: &Machine,
        brief: &DesignBrief,
        motion: Option<&Motion>,
    ) -> Result<(Machine, CounterweightReport), Failure> {
        report_removed(machine, "");
        self.find(machine, brief, motion)
    }

    /// Finds the counterweights as [`run`](Self::run) does, without notes.
    pub fn find(
        &self,
        machine: &Machine,
        brief: &DesignBrief,
        motion: Option<&Motion>,
    ) -> Result<(Machine, CounterweightReport), Failure> {
        let spec = self.spec(machine, brief, motion)?;
        let (machine, bars) = self.bars(machine, brief)?;
        let lengths = self.lengths(brief, &spec);
        let within = match self.seconds.filter(|_| lengths.is_some()) {
            Some(seconds) if !(seconds.is_finite() && seconds > 0.0) => {
                return Err(Failure::wrong_input(format!("--seconds {seconds}: want a time above 0 in s")));
            }
            seconds => seconds.unwrap_or(f64::INFINITY),
        };
        let stock = spec.stock;
        let request = CounterweightRequest { spec, lengths, front: self.front.map(usize::from), bars };
        let begun = Instant::now();
        let mut seek_on = |_| begun.elapsed().as_secs_f64() < within;
        balance_by_weights(&machine, &request, motion, &mut seek_on, &goes_on).map_err(|why| self.failure(why, &stock))
    }

    /// Converts the reason why there are no counterweights into a failure.
    pub fn failure(&self, why: NoCounterweights, stock: &CounterweightStock) -> Failure {
        match why {
            NoCounterweights::Lengths(why) => lengths_failure(why),
            NoCounterweights::Weights(why) => self.refusal(&why, &why, stock),
            NoCounterweights::Front(why) => request_failure(why),
            NoCounterweights::Cut(NoCut::Weights(why)) => self.refusal(&why, &why, stock),
            NoCounterweights::Cut(ref cut @ NoCut::Bounds { ref why, .. }) => self.refusal(cut, why, stock),
            NoCounterweights::Cut(why) => cut_failure(why),
            NoCounterweights::Machine(why) => why.into(),
            NoCounterweights::Stopped => Failure::Stopped,
        }
    }
}

/// Prints which counterweights are removed from a machine; the message begins with `of`, the name of the machine.
pub fn report_removed(machine: &Machine, of: &str) {
    let taken_off = removed_weights(machine);
    if taken_off.is_empty() {
        return;
    }
    let each = taken_off.iter().map(|weight| {
        let beside = match weight.across {
            0.0 => String::new(),
            across => format!(", {} m left of its axis", nine_digits(across)),
        };
        format!("{} kg at {} m of link {}{beside}", nine_digits(weight.mass), nine_digits(weight.at), weight.link)
    });
    print_message(format!(
        "{of}taken off before others are sought: {}; fixed = true in a [[counterweight]] keeps it",
        each.collect::<Vec<_>>().join("; ")
    ));
}

/// Converts the reason why there are no lengths into a failure: wrong input, or no answer.
fn lengths_failure(why: NoLengths) -> Failure {
    match why {
        NoLengths::None { .. } => Failure::no_answer(why),
        NoLengths::Weights(why) => request_failure(why),
        why => Failure::wrong_input(why),
    }
}

/// Converts the reason why there are no counterweights into a failure: wrong input, or no answer.
pub fn request_failure(why: CounterweightError) -> Failure {
    if is_wrong_input(&why) { Failure::wrong_input(why) } else { Failure::no_answer(why) }
}

fn is_wrong_input(why: &CounterweightError) -> bool {
    matches!(
        why,
        CounterweightError::OutOfRange { .. }
            | CounterweightError::Twice(_)
            | CounterweightError::RotorTwice(_)
            | CounterweightError::FreeRotorOfFront(_)
            | CounterweightError::NoRotor(_)
            | CounterweightError::PayloadOfAssembly
    )
}

/// Converts the reason why no machine can be cut into a failure: wrong input, or no answer.
pub fn cut_failure(why: NoCut) -> Failure {
    match why {
        NoCut::Weights(why) => request_failure(why),
        NoCut::Bars(_) => Failure::wrong_input(why),
        NoCut::Bounds { .. } | NoCut::Unsettled(_) => Failure::no_answer(why),
    }
}

/// Parses the shape of counterweights.
fn shape(text: &str) -> Result<CounterweightForm, String> {
    let want = || "want disc, or ring,A, half-ring,A or box,W with a length in m, as ring,0.01".to_owned();
    let size = |size: &str| size.trim().parse().map_err(|_| want());
    match text.split_once(',') {
        None if text.trim() == "disc" => Ok(CounterweightForm::Disc),
        None => Err(want()),
        Some((kind, given)) => match kind.trim() {
            "ring" => size(given).map(CounterweightForm::Ring),
            "half-ring" => size(given).map(CounterweightForm::HalfRing),
            "box" => size(given).map(CounterweightForm::Box),
            _ => Err(want()),
        },
    }
}

/// Parses a number; its range is checked where it is used.
fn number(text: &str) -> Result<f64, String> {
    text.trim().parse().map_err(|_| "want a number, as 0.05".to_owned())
}

/// Parses WIDTH,THICKNESS[,MATERIAL], m.
fn bars(text: &str) -> Result<BarStock, String> {
    let want = || "want a width and a thickness in m, and a material, as 0.03,0.006,steel".to_owned();
    let words: Vec<&str> = text.split(',').map(str::trim).collect();
    let (lengths, material) = match words[..] {
        [width, thickness] => ([width, thickness], BarStock::default().material),
        [width, thickness, material] => ([width, thickness], material.to_lowercase()),
        _ => return Err(want()),
    };
    let [width, thickness] = lengths.map(|word| word.parse().ok().filter(|x: &f64| x.is_finite() && *x > 0.0));
    let (width, thickness) = width.zip(thickness).ok_or_else(want)?;
    Ok(BarStock { width, thickness, material, ..BarStock::default() })
}

/// Parses LO,HI, kg.
fn payload(text: &str) -> Result<[f64; 2], String> {
    parse_bounds(text).ok_or_else(|| "want two numbers, as 0.1,0.5".to_owned())
}

fn objective(text: &str) -> Result<Objective, String> {
    let want = || "want mass, inertia, momentum, torque, or several with their weights, as mass=1,inertia=5".to_owned();
    let mut objective = Objective { mass: 0.0, ..Objective::mass() };
    for part in text.split(',') {
        let (word, weight) = part.split_once('=').map_or((part, "1"), |(word, weight)| (word, weight));
        let weight: f64 = weight.trim().parse().ok().filter(|w| (0.0..=1e6).contains(w)).ok_or_else(want)?;
        match word.trim() {
            "mass" => objective.mass = weight,
            "inertia" => objective.inertia = weight,
            "momentum" => objective.momentum = weight,
            "torque" => objective.torque = weight,
            _ => return Err(want()),
        }
    }
    match objective.mass + objective.inertia + objective.momentum + objective.torque > 0.0 {
        true => Ok(objective),
        false => Err(want()),
    }
}

/// Columns of the table of a Pareto front.
pub const FRONT_HEADINGS: [&str; 6] =
    ["added kg", "Σ D_k kg m²", "torque N m", "workspace m²", "off by kg m", "relative gap"];

/// Returns the cells of one machine of a Pareto front.
pub fn front_cells(point: &FrontPoint) -> [String; 6] {
    let or_none = |x: Option<f64>| x.map_or_else(|| "–".into(), |x| fixed_or_finer(x, 6));
    let FrontPoint { added_mass, inertia, torque, workspace, residual_if_misplaced, relative_gap, certified } = *point;
    let [added_mass, inertia, off_by] = [added_mass, inertia, residual_if_misplaced].map(|x| fixed_or_finer(x, 6));
    [added_mass, inertia, or_none(torque), or_none(workspace), off_by, gap_cell(relative_gap, certified)]
}

/// Returns the relative gap to the minimum, and whether it is certified.
pub fn gap_cell(gap: Option<f64>, certified: bool) -> String {
    let mark = if certified { "" } else { ", not certified" };
    gap.map_or_else(|| "–".into(), |gap| format!("{gap:.1e}{mark}"))
}

/// Formats counterweights, one a row.
pub fn weights_table(weights: &[Counterweight]) -> TextTable {
    let off_axis = weights.iter().any(|weight| weight.across != 0.0);
    let some =
        |cells: [String; 5]| cells.into_iter().enumerate().filter(move |(i, _)| off_axis || *i != 3).map(|(_, c)| c);
    let first = weights.first().map(Counterweight::shape).unwrap_or_default();
    let size = if matches!(first, CounterweightShape::Box { .. }) { "length m" } else { "radius m" };
    let heads = ["counterweight on link", "kg", "at m", "left of axis m", size].map(String::from);
    let mut table = TextTable::new(some(heads));
    for w in weights {
        let (_, size) = w.free_size();
        let [mass, at, across, size] = [w.mass, w.at, w.across, size].map(|x| fixed_or_finer(x, 6));
        table.row(some([w.link.clone(), mass, at, across, size]));
    }
    table
}

/// Returns the shape that counterweights have in common, for a title; empty for discs.
pub fn shape_words(weights: &[Counterweight]) -> String {
    let first = weights.first().map(Counterweight::shape).unwrap_or_default();
    match first {
        CounterweightShape::Ring { inner_radius, .. } | CounterweightShape::HalfRing { inner_radius, .. } => {
            format!(" · {}, inner radius {} m", first.name(), nine_digits(inner_radius))
        }
        CounterweightShape::Box { width, .. } => format!(" · box, {} m wide", nine_digits(width)),
        CounterweightShape::Point | CounterweightShape::Disc { .. } => String::new(),
    }
}

/// Formats a Pareto front.
pub fn front_table(points: &[FrontPoint]) -> TextTable {
    let mut table = TextTable::new(FRONT_HEADINGS);
    points.iter().for_each(|point| table.row(front_cells(point)));
    table
}

/// Formats the report as text.
pub fn text(report: &CounterweightReport, machine: &Machine) -> String {
    let (table, shape) = (weights_table(&report.weights), shape_words(&report.weights));
    let bought = report.bars.as_ref().is_some_and(|bars| bars.exact_value.is_some());
    let sure = match report.certified {
        true => format!("within {:.1e} of the best", report.gap),
        false if bought => "rounded as sold, not certified".to_owned(),
        false => format!("not certified: the best may lie {} below", significant(report.gap)),
    };
    let mut text = format!(
        "{} · {} kg added{shape} · {sure}\n\n{table}\n{}\n{}",
        machine.name(),
        fixed_or_finer(report.measures.added_mass, 6),
        measures::text(&report.measures),
        balance_tables(&report.balance, machine)
    );
    text.extend(report.weights.iter().filter_map(thin_wall).map(|remark| format!("\n{remark}\n")));
    if let Some(torque) = report.torque {
        text.push_str(&format!("\ngreatest torque of the task {} N m\n", fixed(torque, 6)));
    }
    if let Some(sought) = &report.optimised_lengths {
        let mut table = TextTable::new(["length", "m"]);
        sought.lengths.iter().for_each(|(name, length)| table.row([name.clone(), fixed(*length, 6)]));
        let LengthsReport { starts, agreeing, machines, reach, .. } = sought;
        let workspace = sought.workspace.map_or(String::new(), |x| format!(", workspace {} m²", fixed(x, 6)));
        text.push_str(&format!(
            "\nlengths, not certified: the best of {machines} machines; {agreeing} of {starts} starts ended there\n\n{table}\nreach {} m{workspace}\n",
            fixed(*reach, 6)
        ));
    }
    if let Some(bars) = &report.bars {
        text.push_str(&format!(
            "\nas cut: bars {} kg, longest tail {} mm, the best of {}; left of (7) {:.1e} kg m, of (8) {:.1e} kg m²\n",
            fixed_or_finer(bars.mass, 3),
            fixed_or_finer(1e3 * bars.tail, 1),
            counted(bars.tried, "cut"),
            bars.force_residual,
            bars.coupling_residual
        ));
        text.extend(bars.replaced().map(|sentence| format!("{sentence}\n")));
        if let Some(exact) = bars.exact_value {
            text.push_str(&format!(
                "Rounded, the objective is {}; the discs before rounding, certified on these bars, have {}.\n",
                nine_digits(exact + report.gap),
                nine_digits(exact)
            ));
        }
        text.extend(bars.broken_bounds.iter().map(|broken| format!("Rounding breaks a bound: {broken}.\n")));
    }
    if !report.rotors.is_empty() {
        let mut table = TextTable::new(["rotor of drive", "inertia kg m²", "ratio"]);
        for rotor in &report.rotors {
            table.row([rotor.drive.clone(), fixed(rotor.inertia, 9), fixed(rotor.ratio, 6)]);
        }
        text.push_str(&format!("\n{table}"));
    }
    if let Some((first, last)) = report.payload.first().zip(report.payload.last()) {
        let mut table = TextTable::new(["payload kg", "residual of (7) kg m", "residual of (8) kg m²"]);
        for at in &report.payload {
            table.row([fixed(at.payload, 4), fixed(at.force, 6), fixed(at.coupling, 6)]);
        }
        let middle = fixed(0.5 * (first.payload + last.payload), 6);
        let bounds = match report.is_balanced {
            true => "",
            false => {
                "the largest |g_k|, or |C_kl| divided by the reach, over all payloads is as small as possible; to \
                 balance the middle one instead, use --set payload.mass, not --payload\n"
            }
        };
        text.push_str(&format!("\n{bounds}in the results and the new file, the payload is {middle} kg\n\n{table}"));
    }
    if !report.front_points.is_empty() {
        text.push_str(&format!("\n{}", front_table(&report.front_points)));
    }
    text
}
