using Kinefab.Numerics;

namespace Kinefab.Dynamics.Rattle;

/// <summary>
/// What is done to a step's start before its parts: a pose that the last step did not leave so, as where a program moved a body, is closed, and speeds that
/// the joints forbid are taken off. What was found is said.
/// </summary>
internal sealed class StepStart
{
    private readonly LaneBatch<ScalarLane> _batch;
    private readonly ConjugateGradient _conjugateGradient;
    private readonly PositionProjection _closure;
    private bool _isMoved;

    // The row whose speed is the largest forbidden one; -1: there is none.
    private int _forbidden = -1;
    private double _forbiddenSpeed;

    public StepStart(LaneBatch<ScalarLane> batch, ConjugateGradient conjugateGradient)
    {
        _batch = batch;
        _conjugateGradient = conjugateGradient;
        _closure = new PositionProjection(batch, conjugateGradient);
    }

    /// <summary>Whether the last step began by closing its start pose.</summary>
    public bool HasClosed { get; private set; }

    /// <summary>Whether the last step began by taking speeds off that the joints forbid.</summary>
    public bool HasForbiddenSpeed => _forbidden >= 0;

    /// <summary>Whether <see cref="ProjectSpeeds"/> was asked for in this step.</summary>
    public bool HasProjectedSpeeds { get; private set; }

    /// <summary>Whether a pose that the last step did not leave so is still open.</summary>
    public bool IsLeftOpen() => _isMoved && IsOpen();

    /// <inheritdoc cref="PositionProjection.IsOpen"/>
    public bool IsOpen() => _closure.IsOpen();

    /// <summary>Closes a pose that the last step did not leave so, and finds the speeds that it forbids.</summary>
    /// <param name="tolerance">Largest C, m or rad.</param>
    /// <param name="isMoved">Whether the pose is not the one that the last step left; a limit that is newly passed counts as such.</param>
    public void Close(double tolerance, bool isMoved)
    {
        HasProjectedSpeeds = false;
        _isMoved = isMoved || (_batch.ActiveSet != null && _batch.ActiveSet.IsNewlyPassed());
        HasClosed = _isMoved && _closure.TryClose(tolerance);
        _forbidden = _isMoved && !_batch.Shape.IsInconsistent ? InitialVelocityProjection.Find(_batch, out _forbiddenSpeed) : -1;
    }

    /// <summary>Takes off the speeds that the joints forbid.</summary>
    public void ProjectSpeeds()
    {
        HasProjectedSpeeds = true;
        RattleStep<ScalarLane>.Rebuild(_batch);
        InitialVelocityProjection.Apply(_batch, _conjugateGradient);
    }

    /// <summary>The step is as one before it that left nothing to close: nothing is said of its start.</summary>
    public void Forget()
    {
        HasClosed = false;
        _forbidden = -1;
    }

    /// <summary>The largest forbidden speed.</summary>
    /// <param name="island">The island that was stepped; the batch may be of another of its shape.</param>
    public ForbiddenSpeed Forbidden(Island island) =>
        new() { Body = island.Bodies[0], Joint = island.JointOf(_forbidden), Speed = _forbiddenSpeed, IsAngular = island.IsInRadians(_forbidden) };

    /// <summary>What was moved to close the pose.</summary>
    /// <param name="island">The island that was stepped; the batch may be of another of its shape.</param>
    public ClosedPose Closed(Island island) => new()
    {
        Body = island.Bodies[0],
        Joint = island.JointOf(_closure.Worst),
        Error = _closure.WorstError,
        IsAngular = island.IsInRadians(_closure.Worst),
        Distance = _closure.Distance,
        Angle = _closure.Angle,
    };
}
