//! The choices of a task: its kind, the shape of its path, the motion at corners, and the quantity to minimise.

use stillbase_settings::word::words;

words! {
    /// Kind of a task: how the redundancy of three drives over two coordinates is resolved.
    pub enum TaskKind {
        Reactionless = "reactionless", "Stay reactionless", "Hold b: nothing reaches the base (case 3)";
        /// Along the end effector's path.
        #[serde(alias = "tip-line")]
        MinimumNorm = "minimum-norm", "Minimum-norm rates", "The usual inverse, q̇ = J⁺ẋ (case 1)";
        SameTip = "same-tip", "Drive 1 apart", "The end effector as in case 3, drive 1 elsewhere (case 2)";
        /// b changes as little as its corridor allows.
        LeastReaction = "least-reaction", "Least reaction", "Any path, b changing as little as it must";
        ChangeB = "change-b", "Change b, at a price", "From A on one plane to B on another: n_B = −D₁ b̈";
        /// A closed path may be repeated several times.
        ZeroMomentum =
            "zero-momentum", "Zero momentum", "Reactionless on any machine; on a closed path the joints may drift";
        /// The arm returns to its pose; with nothing that holds it, the base does not.
        TurnBase = "turn-base", "Turn the base", "A closed motion of the arm turns a base that floats";
        /// Samples of drive angles are followed unchanged, those of the end effector on the plane b = const.
        Given = "given", "As given", "By samples over time, from a file: stillbase import";
    }
}

words! {
    /// Shape of the path between the points of a task.
    pub enum PathShape {
        JointLine = "joint-line", "Joint lines", "Straight in joint space";
        Line = "line", "Straight lines", "The end effector on straight lines";
        Arc = "arc", "Arc", "One arc through three points";
        Spline = "spline", "Spline", "A smooth curve through all points";
        Freehand = "freehand", "Freehand", "As drawn with the pointer: P, then drag";
    }
}

words! {
    /// Motion at the corners between straight lines.
    pub enum Corners {
        Stop = "stop", "Stop", "The motion comes to rest";
        Blend = "blend", "Blend", "The corner is rounded off";
    }
}

words! {
    /// Quantity that a redundant motion minimises.
    pub enum ReactionObjective {
        /// The root of the mean square of n_B.
        MeanSquare = "mean-square", "Least mean square", "∫ n_B² dt as small as can be";
        Peak = "peak", "Least peak", "The greatest |n_B| as small as can be";
    }
}
