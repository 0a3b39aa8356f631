using System.Collections.Generic;

namespace UnityEngine
{
    public class Transform : Component
    {
        internal readonly List<Transform> Children = new List<Transform>();
        private Transform? above;

        protected internal Transform()
        {
        }

        public Vector3 localPosition { get; set; }
        public Quaternion localRotation { get; set; } = Quaternion.identity;
        public Vector3 localScale { get; set; } = Vector3.one;

        public Transform? parent
        {
            get => above;
            set => SetParent(value, true);
        }

        public Vector3 position
        {
            get => above == null ? localPosition : above.TransformPoint(localPosition);
            set => localPosition = above == null ? value : above.InverseTransformPoint(value);
        }

        public Quaternion rotation
        {
            get => above == null ? localRotation : above.rotation * localRotation;
            set => localRotation = above == null ? value : Quaternion.Inverse(above.rotation) * value;
        }

        /// <summary>Correct unless a rotated child below a non-uniform scale is sheared.</summary>
        public Transform root => above == null ? this : above.root;

        public Vector3 lossyScale => above == null ? localScale : Vector3.Scale(above.lossyScale, localScale);

        public void SetParent(Transform? parent, bool worldPositionStays)
        {
            Vector3 place = position;
            Quaternion turned = rotation;
            Transform? before = above;
            above?.Children.Remove(this);
            above = parent;
            above?.Children.Add(this);
            UnityShim.World.SendChildrenChanged(before);
            UnityShim.World.SendChildrenChanged(above);
            if (worldPositionStays)
            {
                SetPositionAndRotation(place, turned);
            }
            UnityShim.World.RefreshActivity(gameObject);
        }

        /// <summary>True for the transform itself, as in Unity.</summary>
        public bool IsChildOf(Transform parent) =>
            ReferenceEquals(this, parent) || (above != null && above.IsChildOf(parent));

        public int childCount => Children.Count;

        public Transform GetChild(int index) => Children[index];

        public int GetSiblingIndex() => above is object
            ? above.Children.IndexOf(this)
            : UnityShim.World.RootIndexOf(gameObject);

        public Transform? Find(string n) => Children.Find(child => child.name == n);

        public void SetPositionAndRotation(Vector3 position, Quaternion rotation)
        {
            this.position = position;
            this.rotation = rotation;
        }

        public void GetPositionAndRotation(out Vector3 position, out Quaternion rotation)
        {
            position = this.position;
            rotation = this.rotation;
        }

        public Vector3 TransformPoint(Vector3 position) => this.position + rotation * Vector3.Scale(lossyScale, position);

        public Vector3 InverseTransformPoint(Vector3 position)
        {
            Vector3 turned = Quaternion.Inverse(rotation) * (position - this.position);
            Vector3 scale = lossyScale;
            return new Vector3(turned.x / scale.x, turned.y / scale.y, turned.z / scale.z);
        }

        public Vector3 TransformDirection(Vector3 direction) => rotation * direction;
    }
}
