namespace KinefabUnity
{
    /// <summary>What ended a drive or a drag.</summary>
    public enum KinefabStop
    {
        /// <summary>Nothing: it is where it was sent.</summary>
        None,

        /// <summary>A joint's limit; the mechanism stands at it.</summary>
        Limit,

        /// <summary>A dead point: the driven coordinate goes no further on this branch; the mechanism stands just before it.</summary>
        DeadPoint,

        /// <summary>A dragged point can come no nearer.</summary>
        OutOfReach,

        /// <summary>The joints do not close: the parts stand where they fit best.</summary>
        NotClosed,

        /// <summary>There is no mechanism; <see cref="KinefabMechanism.Problem"/> says why.</summary>
        NoMechanism,
    }

    /// <summary>What came of a drive or a drag. Limits and dead points are results, not errors.</summary>
    public readonly struct KinefabResult
    {
        internal KinefabResult(KinefabStop stop, double fraction, int branches, string limit, bool isUpper)
        {
            Stop = stop;
            Fraction = fraction;
            Branches = branches;
            Limit = limit;
            IsUpper = isUpper;
        }

        /// <summary>What ended it.</summary>
        public KinefabStop Stop { get; }

        /// <summary>It is where it was sent.</summary>
        public bool Reached => Stop == KinefabStop.None;

        /// <summary>Share of the way that was gone, 0 to 1.</summary>
        public double Fraction { get; }

        /// <summary>How many ways led on where branches of motion meet and nothing told which to take; the straightest was taken. Else 0.</summary>
        public int Branches { get; }

        /// <summary>Name of the coordinate whose limit it stands at; null: none.</summary>
        public string Limit { get; }

        /// <summary>It is the upper end in the joint's own sense, the file's.</summary>
        public bool IsUpper { get; }

        /// <summary>Limit (upper limit of Slide) after 62.5 % of the way.</summary>
        public override string ToString()
        {
            string limit = Limit == null ? "" : " (" + (IsUpper ? "upper" : "lower") + " limit of " + Limit + ")";
            return Reached ? "reached" + limit : Stop + limit + " after " + (100 * Fraction).ToString("0.###", System.Globalization.CultureInfo.InvariantCulture) + " % of the way";
        }
    }

    /// <summary>What moves the parts while the game plays. In the editor it is always the solver.</summary>
    public enum KinefabMover
    {
        /// <summary>The solver: every joint closed to rounding. Rigidbodies are kinematic and are sent by MovePosition and MoveRotation.</summary>
        Exact,

        /// <summary>
        /// The joints' own drives, whose targets are the freedoms' values; physics moves the parts, an angle by the shorter way: one that is to turn
        /// further than by half a turn is sent there in several frames.
        /// </summary>
        JointDrives,

        /// <summary>Physics alone; the values follow the parts.</summary>
        Physics,
    }
}
