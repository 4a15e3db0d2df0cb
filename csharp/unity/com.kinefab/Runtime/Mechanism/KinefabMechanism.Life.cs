using System;
using Kinefab.Kinematics;
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
            valuesOf = Array.ConvertAll(freedoms, freedom => freedom.FullName);
        }

        /// <summary>Unity calls it after it has read the component, also after Undo.</summary>
        void ISerializationCallbackReceiver.OnAfterDeserialize() => _isStale = true;

#if UNITY_EDITOR
        private void OnValidate()
        {
            if (_motion != null && _isStale)
            {
                IsReady();
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
            if (Application.isPlaying && pose.Length > 0)
            {
                RemakeJoints();
            }
        }

        private void OnDisable()
        {
            Enabled.Remove(this);
            if (Application.isPlaying)
            {
                _wasSwitchedOff = !gameObject.activeInHierarchy;
                Release();
            }
        }

        private void FixedUpdate()
        {
            if (!Application.isPlaying || _placement == null)
            {
                return;
            }

            if (_wasSwitchedOff)
            {
                // Not in OnEnable: Unity switches nothing on or off below an object that it is just switching on.
                _wasSwitchedOff = false;
                RemakeJoints();
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
        private static void ClearEnabled() => Enabled.Clear();

        private void RemakeJoints()
        {
            if (IsReady() && _placement.HasBodies)
            {
                _placement.RemakeJoints(_motion.Home);
            }
        }

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

        // Reads the scene when it is first needed, and again when its file was imported anew: a prefab's instance in an open scene gets
        // the new parts then, and keeps all that is not serialized. A fault is told once and stays until then.
        private bool IsReady()
        {
            string version = source == null ? "" : source.Version;
            if (!string.Equals(version, _version, StringComparison.Ordinal))
            {
                Read(version);
            }
            else if (_isStale && _motion != null)
            {
                Restore();
            }

            return _motion != null;
        }

        private void Read(string version)
        {
            bool isHeld = _placement != null && isActiveAndEnabled && Application.isPlaying;
            if (isHeld)
            {
                Release();
                _isLetGo = false; // where the old mechanism's parts stand tells nothing about the new one
            }

            Forget();
            _version = version;
            if (source == null)
            {
                _fault = "The scene is missing: import the .kinefab file again.";
                return;
            }

            MotionState motion;
            try
            {
                motion = new MotionState(source.Load(), Array.ConvertAll(freedoms, freedom => freedom.Coordinate));
            }
            catch (Kinefab.Diagnostics.SceneFormatException fault)
            {
                _fault = fault.Message;
                Debug.LogError(fault.Message, this);
                return;
            }

            if (!IsOf(motion.Mechanism))
            {
                _fault = "The .kinefab file has other parts or joints than when this object was made of it: put the file's asset into the scene in its place.";
                return;
            }

            _motion = motion;
            _placement = new PartPlacement(transform, parts, _motion);
            Restore();
            if (isHeld)
            {
                Take();
            }
        }

        // Of an unpacked prefab the parts stay those of the file that there was.
        private bool IsOf(Mechanism mechanism) =>
            parts.Length == mechanism.Scene.Document.GameObjects.Count
            && Array.TrueForAll(freedoms, own => own.Coordinate < mechanism.Coordinates.Count && mechanism.Coordinates[own.Coordinate].Name == own.FullName);

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
                // The file has changed since: as near as the new mechanism gets. Its freedoms may be others, or stand in another order.
                _motion.GoHome();
                if (values.Length == valuesOf.Length && Array.TrueForAll(values, value => !double.IsNaN(value) && !double.IsInfinity(value)))
                {
                    _motion.Set(valuesOf, values);
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
            _version = null;
            _isStale = false;
            _packedMoves = 0;
        }
    }
}
