using System;
using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>
/// Energy of one island's step, part by part: what of it came of nothing since the step's start, and so whether a part may be kept, whether shorter ones
/// would be of use, and whether the step as a whole is fine enough.
/// </summary>
internal sealed class StepEnergy
{
    // Largest change of the energy in a step against its kinetic part, where nothing but known forces does work.
    private const double MostChange = 0.002;

    // Largest growth of the energy in a step, springs included, where scalar rows may take any amount.
    private const double MostGain = 5e-4;

    // Of what energy may change by in a step, what a part may, and, before it is tried in shorter ones from its start, what all may together.
    private const double PartShare = 0.25;
    private const double MostShares = 2;

    // Halvings after which a gain or loss that is still more than a share of what it was at first is none of the step's.
    private const int TellingHalvings = 3;
    private const double KeptGain = 0.5;

    private readonly LaneBatch<ScalarLane> _batch;
    private readonly int _mostKept;
    private double _dt;
    private double _tolerance;
    private bool _isKnown;
    private bool _wasSingular;

    // At the step's start, and after the last part that was taken.
    private EnergyAudit _start;
    private EnergyAudit _end;

    // Of the step up to the next part: energy that came of nothing, J, and what that is of the allowance.
    private double _gain;
    private double _excess;

    // What the longest that was tried of the next part gained, J.
    private double _firstGain;

    private EnergyLedger _ledger;

    /// <param name="batch">The island's.</param>
    /// <param name="mostKept">The most halvings that steps keep.</param>
    public StepEnergy(LaneBatch<ScalarLane> batch, int mostKept)
    {
        _batch = batch;
        _mostKept = mostKept;
    }

    /// <summary>What no part may have more than; null where what does work is not known.</summary>
    public EnergyAudit? Start => _isKnown ? _start : null;

    /// <summary>Whether shorter parts gain or lose as much as the next one.</summary>
    public bool IsOfAnyLength { get; private set; }

    /// <summary>Halvings of the longest that was tried of the next part and gained or lost too much.</summary>
    public int FirstGainHalvings { get; private set; }

    /// <summary>Whether the last part speaks for a longer one.</summary>
    public bool IsSmooth { get; private set; }

    /// <summary>Whether what the parts left too much is more than the account takes from the speeds: the step is to be made again in shorter ones.</summary>
    public bool IsTooCoarse => _isKnown && (_excess > MostShares || !CanTakeGain());

    /// <summary>Whether the next step begins as a singular one.</summary>
    public bool StaysSingular => IsSingular && _isKnown && _end.Excess(_start, false, MostChange) > 1;

    // Whether branches of a loop's motion meet where it stands: what J allows beyond any motion is lost, whatever the step.
    private bool IsSingular { get; set; }

    // What slows a body down to its largest angular speed leaves speeds that the joints forbid, and these go.
    private bool MayLose =>
        IsSingular || _batch.Work.Slowed[0] > 0 || LaneEnergy<ScalarLane>.IsLed(_batch, 0) || _start.IsSprung
        || CompliantAngles<ScalarLane>.HaveActed(_batch, 0, _start.Kinetic) || _batch.ActiveSet is { HasActed: true };

    /// <summary>A step begins.</summary>
    /// <param name="dt">Step, s.</param>
    /// <param name="tolerance">Largest C, m or rad.</param>
    /// <param name="ledger">The island's account.</param>
    /// <param name="isSingular">Whether the last step left it so, see <see cref="StaysSingular"/>.</param>
    public void Begin(double dt, double tolerance, in EnergyLedger ledger, bool isSingular)
    {
        _dt = dt;
        _tolerance = tolerance;
        _ledger = ledger;
        IsSingular = isSingular;
        _wasSingular = isSingular;
        _isKnown = LaneEnergy<ScalarLane>.IsKnown(_batch, 0);
        BeginAgain();
    }

    /// <summary>Nothing is said of this step's: what stood open before it did work on springs when it was closed.</summary>
    public void Ignore() => _isKnown = false;

    /// <summary>The start is where the bodies are.</summary>
    public void MarkStart()
    {
        if (_isKnown)
        {
            _start = new EnergyAudit(_batch, _dt, _tolerance);
        }
    }

    /// <summary>Back to the start.</summary>
    public void BeginAgain()
    {
        _gain = 0;
        _excess = 0;
        BeginPart();
    }

    /// <summary>Another part comes next.</summary>
    public void BeginPart()
    {
        _firstGain = 0;
        IsOfAnyLength = false;
    }

    /// <summary>
    /// Takes down a part, at whose end the batch is built, unless it gained or lost too much. Local errors of a second order method are of the third: where
    /// parts keep to a share of what the step may have, whatever their length, so does their sum.
    /// </summary>
    /// <param name="h">Length, s.</param>
    /// <param name="halvings">Of the step, that make it.</param>
    public bool TryTake(double h, int halvings)
    {
        if (!_isKnown)
        {
            IsSmooth = true;
            return true;
        }

        var end = new EnergyAudit(_batch, _dt, _tolerance);
        double excess = Excess(end, halvings), gain = end.GainSince(_start);
        if (!(excess <= _excess + Math.Max(PartShare, h / _dt)))
        {
            FindGainOfAnyLength(gain - _gain, halvings);
            return false;
        }

        IsSmooth = gain - _gain <= end.Allowed(_start, MayLose, PartShare * (MayLose ? MostGain : MostChange));
        _excess = excess;
        _gain = gain;
        _end = end;
        return true;
    }

    /// <summary>Takes down a part in which the island stood still.</summary>
    public void TakeStop() => _end = new EnergyAudit(_batch, _dt, _tolerance);

    /// <summary>Whether the part that failed last showed that the loop is singular, which changes what may be lost; says so once.</summary>
    public bool HasBecomeSingular()
    {
        bool hasBecome = IsSingular && !_wasSingular;
        _wasSingular = IsSingular;
        return hasBecome;
    }

    /// <summary>Enters the step in the island's account, which takes from the speeds what they have too much.</summary>
    /// <param name="ledger">The island's.</param>
    public void Enter(ref EnergyLedger ledger)
    {
        if (_isKnown && _end.IsClosed)
        {
            double takeable = LaneEnergy<ScalarLane>.Takeable(_batch, 0, _end.Kinetic, out CommonMotion common);
            LaneEnergy<ScalarLane>.Take(_batch, 0, ledger.Enter(_end.GainSince(_start), _end.Moving, takeable, MayLose), takeable, common);
        }
    }

    // In parts as short as steps keep, a violent motion on which no scalar row acts may lose energy: nothing below these is better. Were it allowed to lose
    // at any, while a gain is mended, an energy that swings about its value would be let down step by step. What is left there of a gain the account takes
    // from the speeds.
    private double Excess(in EnergyAudit end, int halvings)
    {
        bool mayLose = MayLose || halvings >= _mostKept;
        return end.Excess(_start, mayLose, mayLose ? MostGain : MostChange);
    }

    // Whether what the account takes of the step at its end is enough.
    private bool CanTakeGain() =>
        !_end.IsClosed || _ledger.CanTake(_end.GainSince(_start), _end.Moving, LaneEnergy<ScalarLane>.Takeable(_batch, 0, _end.Kinetic, out _));

    // What a step that is too long gains or loses, shorter ones do not; what goes where branches of a loop's motion meet, goes whatever their length.
    private void FindGainOfAnyLength(double gain, int halvings)
    {
        if (_firstGain == 0)
        {
            _firstGain = gain;
            FirstGainHalvings = halvings;
        }

        IsOfAnyLength = halvings >= FirstGainHalvings + TellingHalvings && gain / _firstGain > KeptGain;
        IsSingular |= IsOfAnyLength && gain < 0 && _batch.Shape.HasJointLoops;
    }
}
