using System;
using Kinefab.Numerics;

namespace Kinefab.Advice.Runs;

/// <summary>
/// How far a motion goes to and fro with the step: x_k = smooth + A (-1)^k has second differences 4 A (-1)^k beside the small
/// ones of the smooth part. Only four in a row that change sign each time count, so that a stop or a kick does not.
/// </summary>
internal sealed class ShakeMeter
{
    private const double Degrees = 180 / Math.PI;
    private const int Row = 4;

    private Pose _last;
    private Vector3d _velocity;
    private Vector3d _turning;
    private int _count;
    private Track _way;
    private Track _turn;
    private double _ways;
    private double _turns;
    private int _late;

    public AdviceMeasure Mean => _late == 0 ? default : new AdviceMeasure(_ways / _late, _turns / _late * Degrees);

    public void Note(in Pose pose, bool isLate)
    {
        Vector3d velocity = pose.Position - _last.Position;
        Vector3d turning = (_last.Rotation.Conjugate() * pose.Rotation).Vector * 2;
        if ((_last.Rotation.Conjugate() * pose.Rotation).W < 0)
            turning = -turning;
        if (_count >= 2)
        {
            _way.Add(velocity - _velocity);
            _turn.Add(turning - _turning);
        }

        _last = pose;
        _velocity = velocity;
        _turning = turning;
        _count++;
        if (isLate)
        {
            _late++;
            _ways += _way.Amplitude;
            _turns += _turn.Amplitude;
        }
    }

    private struct Track
    {
        private Vector3d _difference;
        private double _l0;
        private double _l1;
        private double _l2;
        private int _alternations;

        /// <summary>A, from the least of the last differences.</summary>
        public readonly double Amplitude => _alternations < Row - 1
            ? 0
            : Math.Min(Math.Min(_l0, _l1), Math.Min(_l2, _difference.Length)) / 4;

        public void Add(Vector3d difference)
        {
            _alternations = Vector3d.Dot(difference, _difference) < 0 ? _alternations + 1 : 0;
            _l0 = _l1;
            _l1 = _l2;
            _l2 = _difference.Length;
            _difference = difference;
        }
    }
}
