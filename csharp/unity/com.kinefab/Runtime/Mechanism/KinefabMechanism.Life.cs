using System;
using Kinefab.Validation;
using UnityEngine;

namespace KinefabUnity
{
    /// <content>From frame to frame: waking, stepping, being stored and read again.</content>
    public sealed partial class KinefabMechanism
    {
        /// <summary>Unity calls it before it stores the component: the state is kept to the last bit.</summary>
        void ISerializationCallbackReceiver.OnBeforeSerialize()
        {
            if (_motion == null || _isStale || _packedMoves == _motion.Moves)
            {
                return;
            }

            _packedMoves = _motion.Moves;
            pose = _motion.Pack();
            values = Array.ConvertAll(freedoms, freedom => _motion.Value(freedom.Coordinate));
        }

        /// <summary>Unity calls it after it has read the component, also after Undo.</summary>
        void ISerializationCallbackReceiver.OnAfterDeserialize() => _isStale = true;

#if UNITY_EDITOR
        private void OnValidate()
        {
            if (_motion != null && _isStale)
            {
                Restore();
            }
        }
#endif

        private void OnEnable()
        {
            Enabled.Add(this);
            if (Application.isPlaying)
            {
                Take();
            }
        }

        private void Start()
        {
            if (Application.isPlaying && pose.Length > 0 && IsReady() && _placement.HasBodies)
            {
                _placement.RemakeJoints(_motion.Home);
            }
        }

        private void OnDisable()
        {
            Enabled.Remove(this);
            if (Application.isPlaying)
            {
                Release();
            }
        }

        private void FixedUpdate()
        {
            if (!Application.isPlaying || _placement == null)
            {
                return;
            }

            if (mover == KinefabMover.Exact)
            {
                _placement.Step(Time.fixedDeltaTime);
            }
            else if (mover == KinefabMover.Physics)
            {
                _placement.ReadBack(closes: false);
            }
        }

        private void Update()
        {
            // While time stands still no physics step comes to put the bodies in place.
            if (Application.isPlaying && _placement != null && mover == KinefabMover.Exact && Time.timeScale == 0)
            {
                _placement.Place(bodiesToo: true);
            }
        }

        // Without a domain reload Unity keeps statics from one play to the next.
        [RuntimeInitializeOnLoadMethod(RuntimeInitializeLoadType.SubsystemRegistration)]
        private static void Reset() => Enabled.Clear();

        // The solver or the drives get hold of the parts.
        private void Take()
        {
            if (source == null || !IsReady())
            {
                return;
            }

            if (mover == KinefabMover.Exact)
            {
                if (_isLetGo && _placement.HasBodies)
                {
                    _placement.ReadBack(closes: true);
                }

                _placement.TakeHold();
                _placement.Place(bodiesToo: false);
            }
            else if (mover == KinefabMover.JointDrives)
            {
                _targets = new JointTargets(_motion.Mechanism, transform, parts, freedoms);
                _targets.Aim(_motion);
            }

            _isLetGo = false;
        }

        private void Release()
        {
            if (_placement == null)
            {
                return;
            }

            _isLetGo = true;
            if (mover == KinefabMover.Exact)
            {
                _placement.LetGo();
            }

            _targets?.GiveBack();
            _targets = null;
        }

        // Shows where the state has come to.
        private void Show()
        {
            if (!Application.isPlaying)
            {
                _placement.Place(bodiesToo: true);
            }
            else if (mover == KinefabMover.Exact)
            {
                _placement.Place(bodiesToo: false);
            }
            else
            {
                _targets?.Aim(_motion);
            }
        }

        // Reads the scene when it is first needed; a fault is told once and stays.
        private bool IsReady()
        {
            if (_motion != null)
            {
                if (_isStale)
                {
                    Restore();
                }

                return true;
            }

            if (_fault != null)
            {
                return false;
            }

            try
            {
                if (source == null)
                {
                    _fault = "The scene is missing: import the .kinefab file again.";
                    return false;
                }

                ValidScene scene = source.Load();
                _motion = new MotionState(scene, Array.ConvertAll(freedoms, freedom => freedom.Coordinate));
            }
            catch (Kinefab.Diagnostics.SceneFormatException fault)
            {
                _fault = fault.Message;
                Debug.LogError(fault.Message, this);
                return false;
            }

            _placement = new PartPlacement(transform, parts, _motion);
            Restore();
            return true;
        }

        private void Restore()
        {
            _isStale = false;
            if (pose.Length == 0)
            {
                if (_motion.Moves > 0)
                {
                    _motion.GoHome();
                }
            }
            else if (!_motion.TryUnpack(pose))
            {
                // The file has changed since: as near as the new mechanism gets.
                _motion.GoHome();
                if (values.Length == freedoms.Length && Array.TrueForAll(values, value => !double.IsNaN(value) && !double.IsInfinity(value)))
                {
                    _motion.Set(values);
                }

                _placement.Place(bodiesToo: !Application.isPlaying);
                return;
            }

            _packedMoves = _motion.Moves;
        }

        private void Forget()
        {
            _motion = null;
            _placement = null;
            _targets = null;
            _fault = null;
            _isStale = false;
            _packedMoves = 0;
        }
    }
}
