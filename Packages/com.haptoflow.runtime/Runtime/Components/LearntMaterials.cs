#nullable enable
using System;
using System.Collections.Generic;
using System.Threading.Tasks;
using UnityEngine;

namespace HaptoFlow
{
    /// <summary>The learnt materials of one engine: each is registered once, by another thread, when a surface that
    /// uses it wakes or is first touched. Until then, and where the engine refuses it, its label is felt. Main thread;
    /// no garbage while nothing changes.</summary>
    internal sealed class LearntMaterials
    {
        private readonly HapticEngine engine;
        private readonly string space;
        private readonly Dictionary<HapticMaterial, Known> known = new Dictionary<HapticMaterial, Known>();
        private readonly double[] stiffness = new double[HapticEngine.MaximumMaterials];
        private readonly Stack<int> free = new Stack<int>();
        private readonly List<Known> waiting = new List<Known>();
        private readonly int labelCount;
        private Task<List<MaterialRegistration>>? running;
        private int taken;

        /// <param name="space">Of the engine's model.</param>
        /// <param name="labelCount">Of the engine's model: materials come behind its labels.</param>
        public LearntMaterials(HapticEngine engine, string space, int labelCount)
        {
            this.engine = engine;
            this.space = space;
            this.labelCount = labelCount;
        }

        /// <summary>Materials that are felt as they were learnt.</summary>
        public int Felt { get; private set; }

        /// <summary>Materials that were refused: their labels are felt instead.</summary>
        public int Refused { get; private set; }

        /// <summary>Where the engine knows a material; asks for it to be registered where it does not yet.</summary>
        /// <param name="isWaiting">It is being registered: nothing is wrong with it yet.</param>
        public bool TryFind(HapticMaterial material, out int index, out bool isWaiting)
        {
            if (!known.TryGetValue(material, out Known found))
            {
                found = new Known(material);
                known.Add(material, found);
                Ask(found);
            }
            index = found.Index;
            isWaiting = found.IsUnderWay || waiting.Contains(found);
            return index >= 0;
        }

        /// <summary>Null for a material that is felt, or that nobody asked for yet.</summary>
        public string? WhyRefused(HapticMaterial material) =>
            known.TryGetValue(material, out Known found) && found.IsRefused ? found.Refusal : null;

        /// <summary>In N/m, of a material that was found.</summary>
        public double StiffnessNewtonsPerMetre(int index) => stiffness[index - labelCount];

        /// <summary>A material may carry another text: what is felt follows. One that nobody touched stays unknown.
        /// </summary>
        public void Change(HapticMaterial material)
        {
            if (known.TryGetValue(material, out Known found) && !ReferenceEquals(found.Text, material.Learnt))
            {
                Ask(found);
            }
        }

        /// <summary>A material is gone, or carries nothing any more: another may take its place.</summary>
        /// <returns>It was known.</returns>
        public bool Forget(HapticMaterial material)
        {
            if (!known.TryGetValue(material, out Known found))
            {
                return false;
            }
            known.Remove(material);
            waiting.Remove(found);
            SetRefused(found, false);
            found.IsGone = true;
            if (!found.IsUnderWay)
            {
                Release(found);
            }
            return true;
        }

        /// <summary>Takes over what was registered meanwhile. Once a frame.</summary>
        /// <returns>A description may mean something else now.</returns>
        public bool Poll()
        {
            if (running == null || !running.IsCompleted)
            {
                return false;
            }
            List<MaterialRegistration> done = running.GetAwaiter().GetResult();
            running = null;
            foreach (MaterialRegistration each in done)
            {
                TakeOver((Known)each.Owner, each);
            }
            StartNext();
            return true;
        }

        /// <summary>Waits until everything that was asked for is registered or refused.</summary>
        public void Finish()
        {
            while (running != null)
            {
                ((IAsyncResult)running).AsyncWaitHandle.WaitOne();
                Poll();
            }
        }

        /// <summary>Waits for what is under way, and begins nothing more: the engine must not be closed beneath it.
        /// </summary>
        public void Close()
        {
            waiting.Clear();
            Finish();
        }

        private void Ask(Known material)
        {
            if (!waiting.Contains(material))
            {
                waiting.Add(material);
            }
            StartNext();
        }

        private void StartNext()
        {
            if (running != null || waiting.Count == 0)
            {
                return;
            }
            var next = new List<MaterialRegistration>();
            foreach (Known each in waiting)
            {
                each.Text = each.Material.Learnt;
                if (each.Index < 0 && free.Count == 0 && taken == HapticEngine.MaximumMaterials)
                {
                    Refuse(each, $"{HapticEngine.MaximumMaterials} learnt materials are in use, which is the most " +
                        "that an engine takes. Use fewer of them in what is loaded at one time.");
                    continue;
                }
                int place = each.Index >= 0 ? each.Index : free.Count > 0 ? free.Pop() : MaterialRegistration.NewPlace;
                taken += place == MaterialRegistration.NewPlace ? 1 : 0;
                each.IsUnderWay = true;
                next.Add(new MaterialRegistration(each, each.Text, place));
            }
            waiting.Clear();
            if (next.Count > 0)
            {
                running = Task.Run(() =>
                {
                    next.ForEach(each => each.Do(engine, space));
                    return next;
                });
            }
        }

        private void TakeOver(Known material, MaterialRegistration done)
        {
            material.IsUnderWay = false;
            bool wasFelt = material.Index >= 0;
            // Where a new text was refused the engine still knows the old one, which nobody asked for.
            material.Index = done.Place;
            taken -= done.Place == MaterialRegistration.NewPlace ? 1 : 0;
            Felt += wasFelt || material.Index < 0 ? 0 : 1;
            if (done.Refusal != null || material.IsGone)
            {
                Release(material);
            }
            else
            {
                stiffness[material.Index - labelCount] = done.StiffnessNewtonsPerMetre;
                SetRefused(material, false);
            }
            if (done.Refusal != null && !material.IsGone)
            {
                Refuse(material, done.Refusal);
            }
        }

        private void Release(Known material)
        {
            if (material.Index >= 0)
            {
                free.Push(material.Index);
                material.Index = -1;
                --Felt;
            }
        }

        private void Refuse(Known material, string why)
        {
            SetRefused(material, true);
            material.Refusal = why;
            HapticMaterial asset = material.Material;
            string label = asset.Description.Label;
            Debug.LogWarning($"HaptoFlow: {asset.name} is felt as its label \"{label}\": {why}", asset);
        }

        private void SetRefused(Known material, bool isRefused)
        {
            Refused += isRefused == material.IsRefused ? 0 : isRefused ? 1 : -1;
            material.IsRefused = isRefused;
        }

        /// <summary>What is known of one material.</summary>
        private sealed class Known
        {
            public Known(HapticMaterial material) => Material = material;

            public HapticMaterial Material { get; }

            /// <summary>As it was asked for last.</summary>
            public string Text { get; set; } = "";

            /// <summary>In the engine; -1 where it is not felt.</summary>
            public int Index { get; set; } = -1;

            public bool IsUnderWay { get; set; }

            public bool IsRefused { get; set; }

            public string Refusal { get; set; } = "";

            public bool IsGone { get; set; }
        }
    }
}
