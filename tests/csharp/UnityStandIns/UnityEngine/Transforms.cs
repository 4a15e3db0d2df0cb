using System;
using System.Collections;
using System.Collections.Generic;

namespace UnityEngine
{
    /// <summary>Poses in the world are of single precision, as Unity's.</summary>
    public sealed partial class Transform : Component, IEnumerable
    {
        internal readonly List<Transform> Children = new List<Transform>();
        private Vector3 _localPosition;
        private Quaternion _localRotation = Quaternion.identity;
        private Vector3 _localScale = Vector3.one;

        public Transform parent { get; private set; }

        public Transform root => parent == null ? this : parent.root;

        public int childCount => Children.Count;

        public Vector3 localPosition
        {
            get => _localPosition;
            set
            {
                _localPosition = value;
                Moved();
            }
        }

        public Quaternion localRotation
        {
            get => _localRotation;
            set
            {
                _localRotation = value;
                Moved();
            }
        }

        public Vector3 localScale
        {
            get => _localScale;
            set
            {
                _localScale = value;
                Moved();
            }
        }

        public Vector3 position
        {
            get => parent == null ? _localPosition : parent.TransformPoint(_localPosition);
            set => localPosition = parent == null ? value : parent.InverseTransformPoint(value);
        }

        public Quaternion rotation
        {
            get => parent == null ? _localRotation : parent.rotation * _localRotation;
            set => localRotation = parent == null ? value : Quaternion.Inverse(parent.rotation) * value;
        }

        /// <summary>Exact unless a turned object hangs under an unevenly scaled one.</summary>
        public Vector3 lossyScale => parent == null ? _localScale : Vector3.Scale(parent.lossyScale, _localScale);

        public Matrix4x4 localToWorldMatrix
        {
            get
            {
                Matrix4x4 own = Matrix4x4.TRS(_localPosition, _localRotation, _localScale);
                return parent == null ? own : parent.localToWorldMatrix * own;
            }
        }

        public Vector3 right => rotation * Vector3.right;

        public Vector3 up => rotation * Vector3.up;

        public Vector3 forward => rotation * Vector3.forward;

        public Transform GetChild(int index) => Children[index];

        public int GetSiblingIndex() => parent == null ? 0 : parent.Children.IndexOf(this);

        public Transform Find(string path)
        {
            int slash = path.IndexOf('/');
            string first = slash < 0 ? path : path.Substring(0, slash);
            Transform found = Children.Find(c => c.name == first);
            return slash < 0 || found == null ? found : found.Find(path.Substring(slash + 1));
        }

        public bool IsChildOf(Transform other) => this == other || (parent != null && parent.IsChildOf(other));

        public void SetParent(Transform parent) => SetParent(parent, worldPositionStays: true);

        public void SetParent(Transform parent, bool worldPositionStays)
        {
            Vector3 at = position;
            Quaternion turned = rotation;
            Vector3 scale = lossyScale;
            Leave();
            this.parent = parent;
            parent?.Children.Add(this);
            if (worldPositionStays)
            {
                Vector3 above = parent == null ? Vector3.one : parent.lossyScale;
                _localScale = new Vector3(scale.x / above.x, scale.y / above.y, scale.z / above.z);
                rotation = turned;
                position = at;
            }

            Moved();
            Player.Renew(gameObject);
        }

        public void SetPositionAndRotation(Vector3 position, Quaternion rotation)
        {
            this.position = position;
            this.rotation = rotation;
        }

        public Vector3 TransformPoint(Vector3 p)
        {
            Vector3 own = _localPosition + _localRotation * Vector3.Scale(_localScale, p);
            return parent == null ? own : parent.TransformPoint(own);
        }

        public Vector3 TransformVector(Vector3 v)
        {
            Vector3 own = _localRotation * Vector3.Scale(_localScale, v);
            return parent == null ? own : parent.TransformVector(own);
        }

        public Vector3 TransformDirection(Vector3 v) => rotation * v;

        public Vector3 InverseTransformPoint(Vector3 p)
        {
            Vector3 own = Quaternion.Inverse(_localRotation) * ((parent == null ? p : parent.InverseTransformPoint(p)) - _localPosition);
            return new Vector3(own.x / _localScale.x, own.y / _localScale.y, own.z / _localScale.z);
        }

        public Vector3 InverseTransformVector(Vector3 v)
        {
            Vector3 own = Quaternion.Inverse(_localRotation) * (parent == null ? v : parent.InverseTransformVector(v));
            return new Vector3(own.x / _localScale.x, own.y / _localScale.y, own.z / _localScale.z);
        }

#if UNITY_2022_2_OR_NEWER
        public void SetLocalPositionAndRotation(Vector3 localPosition, Quaternion localRotation)
        {
            this.localPosition = localPosition;
            this.localRotation = localRotation;
        }
#endif

        public Vector3 InverseTransformDirection(Vector3 v) => Quaternion.Inverse(rotation) * v;

        public IEnumerator GetEnumerator() => Children.ToArray().GetEnumerator();

        internal void Leave()
        {
            parent?.Children.Remove(this);
            parent = null;
        }

        // Unity: a body that exists already follows only with the next step, or Physics.SyncTransforms.
        private void Moved()
        {
            foreach (Component component in gameObject.Components)
            {
                if (component is Rigidbody body)
                {
                    body.MovedAfterMade = true;
                }
            }

            Unsync();
        }

        private void Unsync()
        {
            if (gameObject.GetComponent<Rigidbody>() is Rigidbody body)
            {
                Physics.Unsynced.Add(body);
            }

            for (int i = 0; i < Children.Count; i++)
            {
                Children[i].Unsync();
            }
        }
    }
}
