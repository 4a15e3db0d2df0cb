using System;

namespace Kinefab.Dynamics.Articulations;

/// <summary>
/// Friction, drive, limit and speed limit of one freedom in the sweeps, all on the joint's own speed.
/// Source: DyCpuGpuArticulation.h (5.6.1), DyFeatherstoneArticulation.cpp, solveInternalConstraintRecursive (4.1 and 5.6.1).
/// </summary>
internal struct AxisRows
{
    /// <summary>Change of the joint's speed by a unit of impulse, and its inverse with the rules' compliance.</summary>
    public double Response;
    public double InverseResponse;

    public double MaxFriction;
    public double MaxSpeed;

    private bool _hasDrive;
    private bool _isLimited;
    private double _driveConstant;
    private double _driveSpeed;
    private double _driveShare;
    private double _maxDrive;
    private double _lowGap;
    private double _highGap;

    private double _friction;
    private double _drive;
    private double _low;
    private double _high;

    /// <summary>Impulse of drive and friction in the step, N s or N m s.</summary>
    public readonly double MotorImpulse => _drive + _friction;

    /// <summary>
    /// Implicit Euler of a spring and damper: a = dt (dt k + d), force: x = 1/(1 + a r), impulse = x (dt d vT + dt k gap - a v) + (1 - x) impulse;
    /// acceleration: x = 1/(1 + a), the same by the inverse response.
    /// </summary>
    public void Prepare(in LinkAxis axis, double gap, double position, double dt, ArticulationRules rules)
    {
        _friction = _drive = _low = _high = 0;
        _isLimited = axis.Motion == LinkMotion.Limited;
        _lowGap = position - axis.Lower;
        _highGap = axis.Upper - position;
        _hasDrive = axis.HasDrive;
        if (!_hasDrive)
            return;
        if (rules.ClampsTargets && _isLimited)
            gap = Math.Min(Math.Max(axis.Target, axis.Lower), axis.Upper) - axis.Target + gap;
        double a = dt * (dt * axis.Stiffness + axis.Damping);
        double x = axis.IsAcceleration ? 1 / (1 + a) : Response > 0 ? 1 / (1 + a * Response) : 0;
        double scale = axis.IsAcceleration ? x * InverseResponse : x;
        _driveConstant = scale * dt * (axis.Damping * axis.TargetSpeed + axis.Stiffness * gap);
        _driveSpeed = -scale * a;
        _driveShare = 1 - x;
        _maxDrive = axis.ForceLimit * dt;
    }

    /// <summary>One visit of a sweep; returns the impulse to add.</summary>
    public double Solve(double speed, bool isVelocityIteration, double dt, ArticulationRules rules)
    {
        double total = 0;
        if (MaxFriction > 0)
        {
            double friction = Math.Min(Math.Max(_friction - speed * InverseResponse, -MaxFriction), MaxFriction);
            Give(friction - _friction, ref total, ref speed);
            _friction = friction;
        }

        if (_hasDrive)
        {
            double drive = _driveShare * _drive + _driveSpeed * speed + _driveConstant;
            if (Math.Abs(drive) > _maxDrive)
                drive = drive > 0 ? _maxDrive : -_maxDrive;
            Give(drive - _drive, ref total, ref speed);
            _drive = drive;
        }

        if (_isLimited)
            Give(rules.LimitsHoldInVelocityIterations ? Limit5(speed, isVelocityIteration, dt, rules.LimitShare) : Limit4(speed, isVelocityIteration, dt, rules.LimitShare), ref total, ref speed);
        if (rules.ScalesSpeedsTogether && Math.Abs(speed) > MaxSpeed)
            total += (Math.Min(Math.Max(speed, -MaxSpeed), MaxSpeed) - speed) * InverseResponse;
        return total;
    }

    private readonly void Give(double impulse, ref double total, ref double speed)
    {
        total += impulse;
        speed += impulse * Response;
    }

    private double Limit5(double speed, bool isVelocityIteration, double dt, double share)
    {
        if (_lowGap < 0 || _lowGap + speed * dt < 0)
        {
            double wanted = _lowGap < 0 ? (isVelocityIteration ? speed : -_lowGap * share / dt) : -_lowGap / dt;
            return Hold(ref _low, (wanted - speed) * InverseResponse, 1);
        }

        if (_highGap < 0 || _highGap - speed * dt < 0)
        {
            double wanted = _highGap < 0 ? (isVelocityIteration ? speed : _highGap * share / dt) : _highGap / dt;
            return Hold(ref _high, (wanted - speed) * InverseResponse, -1);
        }

        return GiveBack(speed);
    }

    private double Limit4(double speed, bool isVelocityIteration, double dt, double share)
    {
        if (!isVelocityIteration && (_highGap < 0 || _highGap - speed * dt < 0))
            return Hold(ref _high, Within(speed, (_highGap / dt - speed) * (_highGap < 0 ? share : 1)) * InverseResponse, -1);
        if (!isVelocityIteration && (_lowGap < 0 || _lowGap + speed * dt < 0))
            return Hold(ref _low, Within(speed, (-_lowGap / dt - speed) * (_lowGap < 0 ? share : 1)) * InverseResponse, 1);
        return GiveBack(speed);
    }

    private readonly double Within(double speed, double change) => Math.Min(Math.Max(speed + change, -MaxSpeed), MaxSpeed) - speed;

    // The sum of a limit's impulses only pushes.
    private static double Hold(ref double sum, double change, int sense)
    {
        double next = sense > 0 ? Math.Max(sum + change, 0) : Math.Min(sum + change, 0);
        double given = next - sum;
        sum = next;
        return given;
    }

    // A limit that held in an earlier iteration and is left behind takes its push back, down to rest.
    private double GiveBack(double speed)
    {
        double stop = -speed * InverseResponse;
        double given;
        if (speed > 0)
        {
            given = Math.Max(stop, -_low);
            _low += given;
        }
        else
        {
            given = Math.Min(stop, -_high);
            _high += given;
        }

        return given;
    }
}
